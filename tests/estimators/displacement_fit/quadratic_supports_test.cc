// Supports that end within quadratic elements.

#include <gtest/gtest.h>

#include <cmath>
#include <random>
#include <string_view>

#include "elastimate/core/scene/quadratic_scene.h"
#include "elastimate/estimators/registry.h"
#include "tests/scenes.h"

namespace elastimate {
namespace {

// A bar that a clamp holds from x = 0 to beyond the middle of the edges around
// its end, pulled askew.
Scene ClampedScene(const Eigen::Vector3i& cells, double end) {
  Scene scene;
  scene.mesh = testing::Distorted(testing::BoxMesh(cells, {2, 1, 1}));
  const Eigen::Index num_nodes = scene.mesh.NumNodes();
  const HeldBox clamp = {
      Eigen::Vector3d(-1, -1, -1), Eigen::Vector3d(end, 2, 2),
      Eigen::Array3<bool>::Constant(true), Eigen::Vector3d::Zero()};
  scene.supports = {ComponentMask::Constant(3, num_nodes, false),
                    Eigen::MatrixXd::Zero(3, num_nodes),
                    {clamp}};
  for (Eigen::Index node = 0; node < num_nodes; ++node) {
    scene.supports.held.col(node).setConstant(scene.mesh.nodes(0, node) <= end);
  }
  LoadCase load_case;
  load_case.loads = {BodyForce{Eigen::Vector3d(20, -5, -3)}};
  scene.load_cases = {load_case};
  return scene;
}

// Measured at the vertices of quadratic elements.
class ClampedBar : public ::testing::Test {
 protected:
  static constexpr double kClampedModulus = 12000;
  static constexpr double kClampedRatio = 0.45;

  ClampedBar() {
    MeasureInFinerWorld({kClampedModulus, kClampedRatio}, scene_);
  }

  Scene scene_ = ClampedScene({8, 4, 4}, 0.68);
};

TEST_F(ClampedBar, IsExactWhereTheClampIsABox) {
  const Estimate estimate =
      MakeEstimator("reduced-fe")->Run(QuadraticScene(scene_), {});
  EXPECT_EQ(estimate.status, Status::kOk) << estimate.message;
  EXPECT_NEAR(estimate.elasticity.youngs_modulus / kClampedModulus, 1, 1e-6);
  EXPECT_NEAR(estimate.elasticity.poisson_ratio, kClampedRatio, 1e-6);
}

// Without the box it is open whether the clamp holds the mid-edge nodes beyond
// its vertices.
class OpenClamp : public ClampedBar,
                  public ::testing::WithParamInterface<std::string_view> {
 protected:
  OpenClamp() { scene_.supports.boxes.clear(); }

  Estimate Run(const Scene& scene) const {
    return MakeEstimator(GetParam())->Run(scene, {});
  }
};

TEST_P(OpenClamp, IsWithinWhatItsEndLeavesOpen) {
  Scene narrow = QuadraticScene(scene_);
  ASSERT_EQ(narrow.supports.ends.size(), 1);
  narrow.supports.ends.clear();
  const double without = Run(narrow).elasticity.youngs_modulus;
  EXPECT_GT(without / kClampedModulus, 1.01);
  const Estimate estimate = Run(QuadraticScene(scene_));
  ASSERT_TRUE(estimate.IsUsable()) << estimate.message;
  const double error = estimate.elasticity.youngs_modulus - kClampedModulus;
  EXPECT_LT(std::abs(error), 0.3 * std::abs(without - kClampedModulus));
  // Without noise the end is found, to rounding.
  constexpr double kRounding = 1e-6;
  EXPECT_LT(std::abs(error), kRounding * kClampedModulus +
                                 2 * *estimate.YoungsModulusStandardError());
  EXPECT_LT(std::abs(estimate.elasticity.poisson_ratio - kClampedRatio),
            kRounding + 2 * *estimate.PoissonRatioStandardError());
}

// Displacements that were computed with the mid-edge nodes free.
TEST_P(OpenClamp, IsExactWhereItEndsAtItsVertices) {
  Scene specimen = QuadraticScene(scene_);
  testing::Measure({kClampedModulus, kClampedRatio}, specimen);
  scene_.load_cases[0].displacement =
      specimen.load_cases[0].displacement.leftCols(scene_.mesh.NumNodes());
  scene_.is_of_linear_elasticity = true;
  const Estimate estimate = Run(QuadraticScene(scene_));
  EXPECT_EQ(estimate.status, Status::kOk) << estimate.message;
  EXPECT_NEAR(estimate.elasticity.youngs_modulus / kClampedModulus, 1, 1e-6);
  EXPECT_NEAR(estimate.elasticity.poisson_ratio, kClampedRatio, 1e-6);
}

TEST(TwoOpenClamps, AreFoundTogether) {
  constexpr IsotropicElasticity kTruth = {12000, 0.4};
  Scene scene = ClampedScene({8, 3, 3}, 0.6);
  const Eigen::Index num_nodes = scene.mesh.NumNodes();
  // The other one guides the bar.
  const HeldBox guide = {Eigen::Vector3d(1.6, -1, -1), Eigen::Vector3d(4, 4, 4),
                         Eigen::Array3<bool>(false, true, true),
                         Eigen::Vector3d::Zero()};
  scene.supports.boxes.push_back(guide);
  for (Eigen::Index node = 0; node < num_nodes; ++node) {
    if (guide.Contains(scene.mesh.nodes.col(node))) {
      scene.supports.held.col(node) << false, true, true;
    }
  }
  MeasureInFinerWorld(kTruth, scene);
  scene.supports.boxes.clear();
  const Scene quadratic = QuadraticScene(scene);
  ASSERT_EQ(quadratic.supports.ends.size(), 2);
  Scene free = quadratic;
  free.supports.ends.clear();
  const Estimate of_free = MakeEstimator("reduced-fe")->Run(free, {});
  const Estimate estimate = MakeEstimator("reduced-fe")->Run(quadratic, {});
  ASSERT_TRUE(estimate.IsUsable()) << estimate.message;
  const double error =
      std::abs(estimate.elasticity.youngs_modulus - kTruth.youngs_modulus);
  EXPECT_LT(error, 0.3 * std::abs(of_free.elasticity.youngs_modulus -
                                  kTruth.youngs_modulus));
  EXPECT_LT(error, 1e-6 * kTruth.youngs_modulus +
                       2 * *estimate.YoungsModulusStandardError());
}

// A clamp of elements half the size that ends near the free vertices, which no
// cut of the mesh is as stiff as.
TEST(OpenClampOfSpecimen, MayEndBeyondTheMiddlesOfEdges) {
  constexpr IsotropicElasticity kTruth = {12000, 0.3};
  constexpr double kEnd = 0.71;
  Scene specimen = ClampedScene({16, 8, 8}, kEnd);
  specimen.mesh.nodes = testing::BoxMesh({16, 8, 8}, {2, 1, 1}).nodes;
  Scene scene = ClampedScene({8, 4, 4}, kEnd);
  scene.mesh.nodes = testing::BoxMesh({8, 4, 4}, {2, 1, 1}).nodes;
  for (Scene* either : {&specimen, &scene}) {
    either->supports.held =
        (either->mesh.nodes.row(0).array() <= kEnd).replicate(3, 1);
  }
  MeasureInFinerWorld(kTruth, specimen);
  const Eigen::MatrixXd fine = specimen.load_cases[0].displacement;
  Eigen::MatrixXd& measured = scene.load_cases[0].displacement;
  measured.resize(3, scene.mesh.NumNodes());
  for (Eigen::Index node = 0; node < scene.mesh.NumNodes(); ++node) {
    Eigen::Index same = 0;
    (specimen.mesh.nodes.colwise() - scene.mesh.nodes.col(node))
        .colwise()
        .squaredNorm()
        .minCoeff(&same);
    measured.col(node) = fine.col(same);
  }
  scene.supports.boxes.clear();
  testing::AddNoise(0.01, 1, scene);
  const Estimate estimate =
      MakeEstimator("reduced-fe")->Run(QuadraticScene(scene), {});
  ASSERT_TRUE(estimate.IsUsable()) << estimate.message;
  EXPECT_LT(
      std::abs(estimate.elasticity.youngs_modulus - kTruth.youngs_modulus),
      2 * *estimate.YoungsModulusStandardError());
  EXPECT_LT(*estimate.YoungsModulusStandardError(),
            0.05 * kTruth.youngs_modulus);
}

// Clamps that end anywhere between two layers of vertices, under noise.  One of
// them ends where no cut of the mesh explains the residual, and is refused.
TEST(OpenClampStatistics, ErrorsAreThoseOfTheEstimates) {
  constexpr int kNumSeeds = 4;
  constexpr int kMostRefused = 1;
  int num_refused = 0;
  constexpr IsotropicElasticity kTruth = {12000, 0.4};
  double square_sum_of_e = 0;
  double square_sum_of_nu = 0;
  for (int seed = 1; seed <= kNumSeeds; ++seed) {
    std::mt19937_64 generator(seed);
    const double end =
        std::uniform_real_distribution<double>(0.7, 1)(generator);
    Scene scene = ClampedScene({6, 3, 3}, end);
    MeasureInFinerWorld(kTruth, scene);
    scene.supports.boxes.clear();
    testing::AddNoise(0.01, seed, scene);
    const Estimate estimate =
        MakeEstimator("reduced-fe")->Run(QuadraticScene(scene), {});
    if (!estimate.IsUsable()) {
      ++num_refused;
      continue;
    }
    square_sum_of_e +=
        std::pow((estimate.elasticity.youngs_modulus - kTruth.youngs_modulus) /
                     *estimate.YoungsModulusStandardError(),
                 2);
    square_sum_of_nu +=
        std::pow((estimate.elasticity.poisson_ratio - kTruth.poisson_ratio) /
                     *estimate.PoissonRatioStandardError(),
                 2);
  }
  EXPECT_LE(num_refused, kMostRefused);
  // Of chi^2 with 4 degrees of freedom, exceeded once in a thousand.
  EXPECT_LT(square_sum_of_e, 18.5);
  EXPECT_LT(square_sum_of_nu, 18.5);
}

INSTANTIATE_TEST_SUITE_P(Estimators, OpenClamp,
                         ::testing::Values("reduced-fe", "iterative-fe"));

}  // namespace
}  // namespace elastimate
