#include "elastimate/estimators/force_balance/solution_check.h"

#include <gtest/gtest.h>

#include <cmath>
#include <string>

#include "elastimate/core/algebra/dense_algebra.h"
#include "elastimate/core/scene/rigid_motion.h"
#include "elastimate/estimators/force_balance/held_scene.h"
#include "elastimate/estimators/force_balance/virtual_fields.h"
#include "tests/regions.h"
#include "tests/scenes.h"
#include "tests/shapes.h"

namespace elastimate {
namespace {

using Check = VirtualFields::Check;

bool IsWithinErrors(const Estimate& estimate,
                    const IsotropicElasticity& truth) {
  constexpr double kErrors = 3;
  return std::abs(estimate.elasticity.youngs_modulus - truth.youngs_modulus) <
             kErrors * estimate.YoungsModulusStandardError().value_or(0) &&
         std::abs(estimate.elasticity.poisson_ratio - truth.poisson_ratio) <
             kErrors * estimate.PoissonRatioStandardError().value_or(0);
}

Scene MeasuredShape(const std::string& shape, const std::string& load,
                    const IsotropicElasticity& truth, double noise, int seed) {
  Scene scene = testing::ShapeScene(shape, load);
  testing::MeasureInFinerWorld(truth, scene);
  testing::AddNoise(noise, seed, scene);
  return scene;
}

// Polynomials smooth away how thin parts bend: the energy that linear elements
// miss there is far more than that of the smoothed displacements.
TEST(SolutionCheck, SeesWhatPolynomialsDoNotDescribe) {
  constexpr IsotropicElasticity kTruth = {5000, 0.3};
  int num_wrong_by_energy = 0;
  for (const std::string load : {"swelling", "bending"}) {
    for (const int seed : {1, 2}) {
      const Scene scene = MeasuredShape("lattice", load, kTruth, 0.03, seed);
      const Estimate by_energy = VirtualFields(Check::kByEnergy).Run(scene, {});
      num_wrong_by_energy +=
          by_energy.IsUsable() && !IsWithinErrors(by_energy, kTruth) ? 1 : 0;
      const Estimate estimate = VirtualFields().Run(scene, {});
      EXPECT_TRUE(!estimate.IsUsable() || IsWithinErrors(estimate, kTruth))
          << load << ", seed " << seed << ": "
          << estimate.elasticity.youngs_modulus;
    }
  }
  EXPECT_GE(num_wrong_by_energy, 3);
}

// A shape that nothing holds: its loads balance, and it has moved and turned as
// a whole.
Scene FreeShape(const std::string& shape, const std::string& load,
                const IsotropicElasticity& truth, double noise, int seed) {
  Scene scene = testing::ShapeScene(shape, load);
  const Eigen::MatrixXd motions = RigidMotionsOf(scene.mesh.nodes);
  Eigen::VectorXd force =
      std::get<NodalForces>(scene.load_cases[0].loads[0]).force.reshaped();
  force -= motions * SolveLeastSquares(motions, force);
  scene.load_cases[0].loads = {
      NodalForces{force.reshaped(3, scene.mesh.NumNodes())}};
  scene.supports.held.setConstant(false);
  const Supports none = scene.supports;
  scene = HeldScene(scene);
  testing::MeasureInFinerWorld(truth, scene);
  scene.is_rigid_motion_free = false;
  scene.supports = none;
  testing::AddNoise(noise, seed, scene);
  Eigen::MatrixXd& displacement = scene.load_cases[0].displacement;
  displacement.reshaped() += motions *
                             Eigen::VectorXd::LinSpaced(6, -0.2, 0.3) *
                             displacement.norm() / motions.norm();
  return scene;
}

TEST(SolutionCheck, SeesItWhereNothingHoldsTheSpecimen) {
  constexpr IsotropicElasticity kTruth = {5000, 0.3};
  int num_wrong_by_energy = 0;
  for (const std::string shape : {"dumbbell", "lattice", "wedge"}) {
    for (const int seed : {1, 2}) {
      const Scene scene = FreeShape(shape, "bending", kTruth, 0.01, seed);
      const Estimate by_energy = VirtualFields(Check::kByEnergy).Run(scene, {});
      num_wrong_by_energy +=
          by_energy.IsUsable() && !IsWithinErrors(by_energy, kTruth) ? 1 : 0;
      const Estimate estimate = VirtualFields().Run(scene, {});
      EXPECT_EQ(estimate.elasticity.youngs_modulus,
                by_energy.elasticity.youngs_modulus);
      EXPECT_TRUE(!estimate.IsUsable() || IsWithinErrors(estimate, kTruth))
          << shape << ", seed " << seed << ": "
          << estimate.elasticity.youngs_modulus;
    }
  }
  EXPECT_GE(num_wrong_by_energy, 3);
}

// Data of these very elements are told from those of a specimen, so that error
// bars are those of noise.
TEST(SolutionCheck, LeavesNothingToElementsThatMadeTheData) {
  constexpr IsotropicElasticity kTruth = {5000, 0.3};
  Scene scene = testing::BlockUnderTraction({6, 6, 6}, {1, 1, 1});
  testing::Measure(kTruth, scene);
  testing::AddNoise(1e-3, 1, scene);
  const Estimate by_energy = VirtualFields(Check::kByEnergy).Run(scene, {});
  const Estimate estimate = VirtualFields().Run(scene, {});
  ASSERT_TRUE(by_energy.IsUsable()) << by_energy.message;
  ASSERT_TRUE(estimate.IsUsable()) << estimate.message;
  EXPECT_EQ(estimate.elasticity.youngs_modulus,
            by_energy.elasticity.youngs_modulus);
  EXPECT_LT(*estimate.YoungsModulusStandardError(),
            0.2 * *by_energy.YoungsModulusStandardError());
  EXPECT_TRUE(IsWithinErrors(estimate, kTruth));
  EXPECT_EQ(estimate.work.factorizations, 1);
  EXPECT_EQ(by_energy.work.factorizations, 0);
  EXPECT_TRUE(estimate.findings.empty()) << estimate.findings[0].text;
}

// Forces that balance in these elements, but for rounding, exclude another
// specimen.
TEST(SolutionCheck, IsNotMadeWithoutNeed) {
  Scene scene = testing::BlockUnderTraction({3, 3, 3}, {1, 1, 1});
  testing::Measure({5000, 0.3}, scene);
  const Estimate estimate = VirtualFields().Run(scene, {});
  ASSERT_TRUE(estimate.IsUsable()) << estimate.message;
  EXPECT_EQ(estimate.work.factorizations, 0);
}

// Next to nu = 1/2 a linear step hardly reaches another nu: slender bars of
// 0.33 were taken for ones of 0.49 +- 0.03.
TEST(SolutionCheck, ReachesAwayFromTheLimit) {
  constexpr IsotropicElasticity kTruth = {5000, 0.33};
  Scene scene = testing::BlockUnderTraction({2, 2, 12}, {0.2, 0.2, 1});
  testing::Measure(kTruth, scene);
  testing::AddNoise(0.01, 1, scene);
  for (const double nu : {0.4, 0.49, 0.499}) {
    Estimate estimate;
    estimate.Accept();
    estimate.elasticity = {4500, nu};
    estimate.covariance = Eigen::Vector2d(100, 1e-3).cwiseAbs2().asDiagonal();
    estimate.error_budget.model = Eigen::Vector2d::Zero();
    Evidence evidence;
    ObservedModel model(scene, {});
    CheckBySolution(scene, {}, model, evidence, estimate);
    EXPECT_GT(1.96 * *estimate.PoissonRatioStandardError(),
              0.8 * (nu - kTruth.poisson_ratio))
        << nu;
  }
}

// Where nu is given, only E can be off.
TEST(SolutionCheck, KeepsWhatIsGiven) {
  constexpr IsotropicElasticity kTruth = {5000, 0.3};
  EstimatorOptions options;
  options.known_poisson_ratio = kTruth.poisson_ratio;
  const Scene scene = MeasuredShape("wedge", "tension", kTruth, 0.01, 1);
  const Estimate estimate = VirtualFields().Run(scene, options);
  EXPECT_EQ(estimate.elasticity.poisson_ratio, kTruth.poisson_ratio);
  EXPECT_FALSE(estimate.PoissonRatioStandardError());
  EXPECT_FALSE(estimate.poisson_ratio_discretization_error);
  ASSERT_TRUE(estimate.IsUsable()) << estimate.message;
  EXPECT_LT(std::abs(estimate.elasticity.youngs_modulus / 5000 - 1),
            3 * *estimate.YoungsModulusStandardError() / 5000);
}

}  // namespace
}  // namespace elastimate
