#include "elastimate/estimators/displacement_fit/corrected_fit.h"

#include <gtest/gtest.h>

#include <cmath>
#include <string_view>

#include "elastimate/core/equilibrium/hierarchical_error.h"
#include "elastimate/core/scene/quadratic_scene.h"
#include "elastimate/core/scene/simplicial_scene.h"
#include "elastimate/estimators/registry.h"
#include "tests/scenes.h"

namespace elastimate {
namespace {

constexpr IsotropicElasticity kBarTruth = {12000, 0.4};

// A coarse bar of quadratic elements that bends under its weight.
Scene BentBar() {
  Scene scene;
  scene.mesh = testing::Distorted(testing::BoxMesh({4, 2, 2}, {2, 1, 1}));
  const Eigen::Index num_nodes = scene.mesh.NumNodes();
  scene.supports.held = ComponentMask::Constant(3, num_nodes, false);
  scene.supports.displacement = Eigen::MatrixXd::Zero(3, num_nodes);
  for (Eigen::Index node = 0; node < num_nodes; ++node) {
    scene.supports.held.col(node).setConstant(scene.mesh.nodes(0, node) < 0.01);
  }
  LoadCase load_case;
  load_case.loads = {BodyForce{Eigen::Vector3d(20, -5, -3)}};
  scene.load_cases = {load_case};
  return QuadraticScene(scene);
}

class CorrectedFitOf : public ::testing::TestWithParam<std::string_view> {};

TEST_P(CorrectedFitOf, IsThatOfFinerElementsWhereTheseWereMeasured) {
  Scene scene = BentBar();
  Scene finer = SimplicialScene(scene);
  MeasureInFinerWorld(kBarTruth, finer);
  scene.load_cases[0].displacement =
      finer.load_cases[0].displacement.leftCols(scene.mesh.NumNodes());
  const Estimate estimate = MakeEstimator(GetParam())->Run(scene, {});
  ASSERT_EQ(estimate.status, Status::kOk) << estimate.message;
  ASSERT_TRUE(estimate.discretization_correction);
  const double error =
      estimate.elasticity.youngs_modulus / kBarTruth.youngs_modulus - 1;
  const double correction = (*estimate.discretization_correction)(0);
  EXPECT_GT(std::abs(correction), 0.005);
  // What finer elements change is known to that.
  EXPECT_LT(std::abs(error),
            2 * HierarchicalError::kTolerance * std::abs(correction));
  EXPECT_LT(std::abs(error), 2 * *estimate.YoungsModulusStandardError() /
                                 kBarTruth.youngs_modulus);
  EXPECT_LT(
      std::abs(estimate.elasticity.poisson_ratio - kBarTruth.poisson_ratio),
      2 * *estimate.PoissonRatioStandardError());
  // They come from the measurement as it is.
  EXPECT_GT(*estimate.displacement_residual, 1e-4);
}

// What finer elements change grows with nu: at the nu that linear ones fit, it
// is half of what it is at the true one.
TEST_P(CorrectedFitOf, IsThatOfQuadraticElementsWhereLinearOnesAreTooStiff) {
  constexpr IsotropicElasticity kTruth = {5000, 0.45};
  Scene scene = testing::BlockUnderTraction({8, 8, 8}, {1, 1, 1});
  testing::MeasureInFinerWorld(kTruth, scene);
  const Estimate estimate = MakeEstimator(GetParam())->Run(scene, {});
  ASSERT_EQ(estimate.status, Status::kOk) << estimate.message;
  ASSERT_TRUE(estimate.discretization_correction);
  const double error = estimate.elasticity.poisson_ratio - kTruth.poisson_ratio;
  const double correction = (*estimate.discretization_correction)(1);
  EXPECT_GT(correction, 0.02);
  EXPECT_LT(std::abs(error), 0.1 * correction);
}

TEST_P(CorrectedFitOf, IsTheFitWhereItsElementsWereMeasured) {
  Scene scene = BentBar();
  testing::Measure(kBarTruth, scene);
  const Estimate estimate = MakeEstimator(GetParam())->Run(scene, {});
  ASSERT_EQ(estimate.status, Status::kOk) << estimate.message;
  EXPECT_NEAR(estimate.elasticity.youngs_modulus / kBarTruth.youngs_modulus, 1,
              1e-6);
  EXPECT_NEAR(estimate.elasticity.poisson_ratio, kBarTruth.poisson_ratio, 1e-6);
}

INSTANTIATE_TEST_SUITE_P(Estimators, CorrectedFitOf,
                         ::testing::Values("reduced-fe", "iterative-fe"));

TEST(CorrectedFit, HasTheIntervalOfItsRivalToo) {
  const Profile of_fit = {{2, 0.2}, {1, 0.3}};
  CorrectedFit corrected;
  EXPECT_EQ(corrected.WithRival(of_fit).lower.poisson_ratio, 0.2);
  corrected.rival = Profile{{4, -0.1}, {3, 0.1}};
  const Profile both = corrected.WithRival(of_fit);
  EXPECT_EQ(both.lower.poisson_ratio, -0.1);
  EXPECT_EQ(both.lower.youngs_modulus, 4);
  EXPECT_EQ(both.upper.poisson_ratio, 0.3);
  EXPECT_EQ(both.upper.youngs_modulus, 1);
}

}  // namespace
}  // namespace elastimate
