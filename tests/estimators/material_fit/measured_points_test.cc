// Fits to displacements of points that are not nodes.

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <string>

#include "elastimate/estimators/plan/expected_information.h"
#include "elastimate/estimators/registry.h"
#include "tests/element_kinds.h"
#include "tests/random_points.h"
#include "tests/scenes.h"
#include "tests/throws.h"

namespace elastimate {
namespace {

using testing::AddNoiseAtPoints;
using testing::KindOfSection;
using testing::MeasureAtPoints;

constexpr double kModulusOfPoints = 5000;
constexpr double kRatioOfPoints = 0.3;
constexpr Eigen::Index kCount = 60;

Scene SceneMeasuredAtPoints(const KindOfSection& parameter) {
  Scene scene = testing::SceneOfKind(parameter);
  testing::MeasureByTextbook({kModulusOfPoints, kRatioOfPoints}, scene);
  MeasureAtPoints(kCount, 1, scene);
  return scene;
}

class PointsOfEachKind : public ::testing::TestWithParam<KindOfSection> {
 protected:
  const Scene scene_ = SceneMeasuredAtPoints(GetParam());
};

// Supports may be displaced, too, which points near them are part of.
TEST_P(PointsOfEachKind, GiveTheTruthWithoutNoise) {
  Scene displaced = testing::SceneOfKind(GetParam());
  testing::DisplaceSupports(displaced);
  testing::MeasureByTextbook({kModulusOfPoints, kRatioOfPoints}, displaced);
  MeasureAtPoints(kCount, 2, displaced);
  for (const std::string name : {"reduced-fe", "iterative-fe", "auto"}) {
    SCOPED_TRACE(name);
    for (const Scene& scene : {scene_, displaced}) {
      const Estimate estimate = MakeEstimator(name)->Run(scene, {});
      EXPECT_EQ(estimate.status, Status::kOk) << estimate.message;
      EXPECT_NEAR(estimate.elasticity.youngs_modulus / kModulusOfPoints, 1,
                  1e-6);
      EXPECT_NEAR(estimate.elasticity.poisson_ratio, kRatioOfPoints, 1e-6);
    }
  }
}

// Points on a face that is held move with it, whatever the material is.
TEST_P(PointsOfEachKind, AreRefusedWhereAllAreHeld) {
  Scene scene = scene_;
  scene.supports.held.setConstant(true);
  scene.supports.held(0, scene.mesh.NumNodes() - 1) = false;
  PointDisplacements& measured = scene.load_cases[0].points;
  for (Eigen::Index point = 0; point < measured.points.Size(); ++point) {
    const auto nodes = scene.mesh.elements.col(measured.points.elements(point));
    if ((nodes.array() == scene.mesh.NumNodes() - 1).any()) {
      measured.displacement.col(point).setConstant(
          std::numeric_limits<double>::quiet_NaN());
    }
  }
  for (const std::string name : {"reduced-fe", "iterative-fe", "auto"}) {
    EXPECT_THROWS_WITH(MakeEstimator(name)->Run(scene, {}),
                       "no free component of the displacement was measured");
  }
}

TEST_P(PointsOfEachKind, AreRefusedWhereNodesAreNeeded) {
  for (const std::string name : {"closed-form", "bounded", "virtual-fields"}) {
    EXPECT_THROWS_WITH(
        MakeEstimator(name)->Run(scene_, {}),
        "load case 1 was measured at points; use --estimator=reduced-fe");
  }
}

INSTANTIATE_TEST_SUITE_P(Kinds, PointsOfEachKind,
                         ::testing::ValuesIn(testing::AllKindsOfSections()),
                         testing::KindTestName);

class PointsOfABlock : public ::testing::Test {
 protected:
  PointsOfABlock() : scene_(testing::SmallScene("cuboid")) {
    testing::Measure({kModulusOfPoints, kRatioOfPoints}, scene_);
    MeasureAtPoints(200, 1, scene_);
    deviation_ = 1e-2 * scene_.load_cases[0].points.displacement.norm() /
                 std::sqrt(600.0);
  }

  Scene scene_;
  double deviation_;
};

// Over 100 seeds a root mean square has a deviation of 7 %, a coverage of 95 %
// one of 2.2 %; 4 of them.
TEST_F(PointsOfABlock, ReachTheCramerRaoBound) {
  constexpr int kSeeds = 100;
  const Eigen::Matrix2d bound =
      CramerRaoBound(scene_, Eigen::Vector2d(kModulusOfPoints, kRatioOfPoints),
                     Eigen::VectorXd::Constant(1, deviation_));
  const auto reduced_fe = MakeEstimator("reduced-fe");
  PreparedEstimator prepared = reduced_fe->Prepare(scene_, {});
  Eigen::Array2d squares = Eigen::Array2d::Zero();
  Eigen::Array2d covered = Eigen::Array2d::Zero();
  for (int seed = 1; seed <= kSeeds; ++seed) {
    Scene noisy = scene_;
    AddNoiseAtPoints(deviation_, seed, noisy);
    const Estimate estimate =
        prepared.Run({noisy.load_cases[0].points.displacement});
    ASSERT_EQ(estimate.status, Status::kOk) << estimate.message;
    const Eigen::Array2d error(
        estimate.elasticity.youngs_modulus - kModulusOfPoints,
        estimate.elasticity.poisson_ratio - kRatioOfPoints);
    squares += error.square();
    covered +=
        (error.abs() < 1.96 * estimate.covariance.diagonal().array().sqrt())
            .cast<double>();
  }
  const Eigen::Array2d ratio =
      (squares / kSeeds / bound.diagonal().array()).sqrt();
  EXPECT_GT(ratio.minCoeff(), 1 - 4 * 0.07);
  EXPECT_LT(ratio.maxCoeff(), 1 + 4 * 0.07);
  // The elements may be coarser than the specimen, for all that noise shows.
  EXPECT_GT(covered.minCoeff() / kSeeds, 0.95 - 4 * 0.022);
}

// The second half is ten times as noisy, and counts a hundredth as much.
TEST_F(PointsOfABlock, CountByTheirStandardDeviations) {
  PointDisplacements& points = scene_.load_cases[0].points;
  points.noise_sd.setConstant(3, 200, deviation_);
  points.noise_sd.rightCols(100) *= 10;
  double squares = 0;
  double squares_alike = 0;
  for (int seed = 1; seed <= 50; ++seed) {
    Scene noisy = scene_;
    AddNoiseAtPoints(1, seed, noisy);
    PointDisplacements& measured = noisy.load_cases[0].points;
    measured.displacement =
        points.displacement + (measured.displacement - points.displacement)
                                  .cwiseProduct(points.noise_sd);
    const auto error = [&] {
      const Estimate estimate = MakeEstimator("reduced-fe")->Run(noisy, {});
      return estimate.elasticity.youngs_modulus - kModulusOfPoints;
    };
    squares += std::pow(error(), 2);
    measured.noise_sd.resize(0, 0);
    squares_alike += std::pow(error(), 2);
  }
  // With equal weights the variance is (1 + 100) / 2 of the first half's, over
  // twice the points; with the right ones it is about that of the first half.
  EXPECT_LT(squares, squares_alike / 10);
}

TEST_F(PointsOfABlock, KeepTheirRowsInAPreparation) {
  const auto estimator = MakeEstimator("iterative-fe");
  PreparedEstimator prepared = estimator->Prepare(scene_, {});
  Eigen::MatrixXd displacement = scene_.load_cases[0].points.displacement;
  EXPECT_TRUE(prepared.Run({displacement}).IsUsable());
  displacement(0, 3) = testing::kNan;
  EXPECT_THROWS_WITH(prepared.Run({displacement}),
                     "are not those of the points that were measured");
}

}  // namespace
}  // namespace elastimate
