// Axes that were given, and are not those of the specimen.

#include "elastimate/estimators/misfit/axis_rotation.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <cmath>
#include <optional>
#include <random>
#include <string>
#include <vector>

#include "elastimate/core/equilibrium/simulated_measurement.h"
#include "elastimate/estimators/registry.h"
#include "tests/anisotropy.h"
#include "tests/element_kinds.h"
#include "tests/scenes.h"

namespace elastimate {
namespace {

constexpr double kDegree = M_PI / 180;

// A measured specimen of this material, and what the fit takes its axes for.
Scene Measured(const Material& material, const Eigen::VectorXd& truth,
               SectionModel model, double noise, unsigned seed) {
  const bool is_solid = model == SectionModel::kSolid;
  Scene scene = testing::SceneOfKind(
      {is_solid ? ElementKind::kTet4 : ElementKind::kTri3, model}, 4);
  scene.materials = {material};
  MeasureMaterials(truth, scene);
  testing::AddNoise(noise, seed, scene);
  return scene;
}

Material Fibres() {
  return {
      "transversely_isotropic", {}, {}, {}, {Eigen::Vector3d(1, -2, 2) / 3}};
}

Material Turned(Material material, const Eigen::Vector3d& about,
                double degrees) {
  for (Eigen::MatrixXd& axis : material.axes) {
    axis = Eigen::AngleAxisd(degrees * kDegree, about.normalized())
               .toRotationMatrix() *
           axis;
  }
  return material;
}

// How many 95 % intervals do not hold the truth.
int NumMissed(const Estimate& estimate, const Eigen::VectorXd& truth) {
  int missed = 0;
  for (Eigen::Index i = 0; i < truth.size(); ++i) {
    const std::optional<Interval>& interval =
        estimate.parameters[std::size_t(i)].interval;
    missed +=
        !interval || truth(i) < interval->lower || truth(i) > interval->upper;
  }
  return missed;
}

const Finding* FindingOf(const Estimate& estimate, FindingCode code) {
  for (const Finding& finding : estimate.findings) {
    if (finding.code == code) {
      return &finding;
    }
  }
  return nullptr;
}

// Across the fibres, as about them nothing turns.
const Eigen::Vector3d kAcross = Eigen::Vector3d(2, 2, 1) / 3;

class WrongAxis : public ::testing::TestWithParam<std::string> {};

TEST_P(WrongAxis, IsSaidAndHeldByTheErrors) {
  const Eigen::VectorXd truth = testing::ConstantsOfFibres();
  for (const double degrees : {1.0, 2.0, 4.0}) {
    Scene scene = Measured(Fibres(), truth, SectionModel::kSolid, 5e-4, 3);
    scene.materials = {Turned(Fibres(), kAcross, -degrees)};
    const Estimate estimate = MakeEstimator(GetParam())->Run(scene, {});
    if (!estimate.IsUsable()) {
      EXPECT_GT(degrees, 2);
      continue;
    }
    EXPECT_EQ(NumMissed(estimate, truth), 0) << degrees;
    const Finding* const said =
        FindingOf(estimate, FindingCode::kGivenValueContradicted);
    EXPECT_TRUE(said != nullptr || degrees < 2) << degrees;
    EXPECT_TRUE(said == nullptr || said->severity == Severity::kWarning);
  }
}

TEST_P(WrongAxis, IsNotSaidWhereItIsRight) {
  for (const double noise : {0.0, 1e-3, 1e-2}) {
    const Scene scene = Measured(Fibres(), testing::ConstantsOfFibres(),
                                 SectionModel::kSolid, noise, 5);
    const Estimate estimate = MakeEstimator(GetParam())->Run(scene, {});
    ASSERT_TRUE(estimate.IsUsable()) << estimate.message;
    EXPECT_FALSE(estimate.Has(FindingCode::kGivenValueContradicted)) << noise;
  }
}

INSTANTIATE_TEST_SUITE_P(Estimators, WrongAxis,
                         ::testing::Values("iterative-fe", "reduced-fe"),
                         [](const auto& info) {
                           return info.param == "reduced-fe" ? "reduced_fe"
                                                             : "iterative_fe";
                         });

// A fit at the true parameters of a specimen.
struct FitAtTruth {
  DisplacementMisfit misfit;
  Eigen::VectorXd x;
  Eigen::VectorXd rows;
  Eigen::MatrixXd sensitivities;
  Eigen::MatrixXd inverse;

  FitAtTruth(const Scene& scene, const Eigen::VectorXd& truth)
      : misfit(scene, {}), x(misfit.Free().VariablesOf(truth)) {
    EXPECT_TRUE(misfit.Evaluate(x, &rows, &sensitivities));
    inverse = (sensitivities.transpose() * sensitivities).inverse();
  }

  // The change of the variables to the minimum of these rows.
  Eigen::VectorXd Step(const Eigen::VectorXd& of_rows) const {
    return -inverse * (sensitivities.transpose() * of_rows);
  }
};

// The step against the angle by which the axes were turned, and against a fit
// with the right axes.
TEST(AxisRotation, IsThatOfTheSpecimen) {
  const Eigen::VectorXd truth = testing::ConstantsOfFibres();
  Scene scene = Measured(Fibres(), truth, SectionModel::kSolid, 0, 1);
  constexpr double kDegrees = 0.1;
  scene.materials = {Turned(Fibres(), kAcross, -kDegrees)};
  FitAtTruth fit(scene, truth);
  const std::optional<AxisRotation> rotation =
      FindAxisRotation(scene, fit.x, fit.rows, fit.sensitivities, fit.inverse,
                       std::nullopt, fit.misfit);
  ASSERT_TRUE(rotation);
  EXPECT_EQ(rotation->num_rotations, 2);
  EXPECT_NEAR(rotation->angle, kDegrees * kDegree, 0.02 * kDegrees * kDegree);
  // The rows are those of the true parameters about the wrong axis: with the
  // rotation, the step of the variables stays where it is.
  const Eigen::VectorXd alone = fit.Step(fit.rows);
  EXPECT_LT((alone + rotation->change).norm(), 0.02 * alone.norm());
}

TEST(AxisRotation, IsOneInThePlane) {
  Eigen::VectorXd truth(4);
  truth << 9e4, 3e4, 0.3, 1.2e4;
  Material lamina = {"orthotropic", {}, {}, {}, {Eigen::Vector2d(0.8, 0.6)}};
  Scene scene = Measured(lamina, truth, SectionModel::kPlaneStress, 2e-3, 2);
  lamina.axes[0] =
      Eigen::Rotation2Dd(2 * kDegree).toRotationMatrix() * lamina.axes[0];
  scene.materials = {lamina};
  const Estimate estimate = MakeEstimator("iterative-fe")->Run(scene, {});
  ASSERT_TRUE(estimate.IsUsable()) << estimate.message;
  EXPECT_TRUE(estimate.Has(FindingCode::kGivenValueContradicted));
  EXPECT_EQ(NumMissed(estimate, truth), 0);
}

// Where the axes are right, chi^2 is that of chance, and little is added to the
// variance of the noise.
TEST(AxisRotationStatistics, LeavesTheErrorsOfRightAxes) {
  constexpr int kSeeds = 300;
  constexpr double kNoise = 1e-2;
  const Eigen::VectorXd truth = testing::ConstantsOfFibres();
  const Scene scene = Measured(Fibres(), truth, SectionModel::kSolid, 0, 1);
  FitAtTruth fit(scene, truth);
  Eigen::VectorXd rows = fit.rows;
  std::mt19937 generator(1);
  std::normal_distribution<double> normal(0, kNoise);
  double added = 0;
  double chi_square = 0;
  for (int seed = 0; seed < kSeeds; ++seed) {
    for (double& row : rows) {
      row = normal(generator);
    }
    const Eigen::VectorXd left = rows + fit.sensitivities * fit.Step(rows);
    const std::optional<AxisRotation> rotation =
        FindAxisRotation(scene, fit.x, left, fit.sensitivities, fit.inverse,
                         kNoise * kNoise, fit.misfit);
    ASSERT_TRUE(rotation);
    chi_square += rotation->chi_square / kSeeds;
    added +=
        rotation->BeyondChance() *
        (rotation->change.array().square() / fit.inverse.diagonal().array())
            .mean() /
        (kNoise * kNoise) / kSeeds;
  }
  // chi^2 of two degrees of freedom has a standard deviation of 2.
  EXPECT_NEAR(chi_square, 2, 4 * 2 / std::sqrt(double(kSeeds)));
  // A twentieth of the errors, of axes that one load tells badly from moduli.
  EXPECT_LT(added, 0.15);
}

}  // namespace
}  // namespace elastimate
