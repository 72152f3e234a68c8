#include "elastimate/estimators/force_balance/bounded.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numeric>

#include "elastimate/core/scene/degrees_of_freedom.h"
#include "elastimate/core/scene/loads.h"
#include "elastimate/estimators/force_balance/closed_form.h"
#include "tests/dense_reference.h"
#include "tests/scenes.h"
#include "tests/throws.h"

namespace elastimate {
namespace {

using testing::AddNoise;
using testing::Measure;
using testing::SmallScene;

Scene NoisyScene(double noise) {
  Scene scene = SmallScene("organ");
  Measure({5e4, 0.3}, scene);
  AddNoise(noise, 4, scene);
  return scene;
}

EstimatorOptions WithBounds(Bounds nu, Bounds youngs) {
  EstimatorOptions options;
  options.poisson_ratio = nu;
  options.youngs_modulus = youngs;
  return options;
}

TEST(Bounded, EqualsTheClosedFormInsideTheBounds) {
  const Scene scene = NoisyScene(0.005);
  const Estimate expected = ClosedForm().Run(scene, {});
  const Estimate estimate =
      Bounded().Run(scene, WithBounds({-0.5, 0.49}, {1e3, 1e6}));
  EXPECT_NEAR(
      estimate.elasticity.youngs_modulus / expected.elasticity.youngs_modulus,
      1, 1e-10);
  EXPECT_NEAR(estimate.elasticity.poisson_ratio,
              expected.elasticity.poisson_ratio, 1e-10);
  EXPECT_TRUE(estimate.active_bounds.empty());
  EXPECT_TRUE(estimate.covariance.isApprox(expected.covariance, 1e-6));
}

// The objective is a convex parabola in nu once t is eliminated, so the
// bounded minimum is at the bound, with the t of eq. 20 there.
TEST(Bounded, IsTheClosedFormOfTheBoundWhenOneIsActive) {
  const Scene scene = NoisyScene(0.05);
  EstimatorOptions known;
  known.known_poisson_ratio = 0.3;
  const Estimate expected = ClosedForm().Run(scene, known);
  const Estimate estimate = Bounded().Run(scene, WithBounds({{}, 0.3}, {}));
  EXPECT_NEAR(
      estimate.elasticity.youngs_modulus / expected.elasticity.youngs_modulus,
      1, 1e-9);
  EXPECT_NEAR(estimate.elasticity.poisson_ratio, 0.3, 1e-12);
  EXPECT_EQ(estimate.active_bounds, std::vector<std::string>{"nu_max"});
  EXPECT_TRUE(estimate.Has(FindingCode::kParametersOnBounds));
}

// A bound that is active does not tell how far the parameter may be from it.
// Only the data do.
TEST(Bounded, StandardErrorsOnABoundAreThoseWithoutIt) {
  Scene scene = NoisyScene(1e-4);
  const double nu = ClosedForm().Run(scene, {}).elasticity.poisson_ratio;
  const Estimate expected = ClosedForm().Run(scene, {});
  const Estimate estimate =
      Bounded().Run(scene, WithBounds({{}, nu - 1e-4}, {}));
  ASSERT_TRUE(estimate.IsUsable()) << estimate.message;
  EXPECT_EQ(estimate.active_bounds, std::vector<std::string>{"nu_max"});
  // The noise level is estimated at a slightly different point.
  EXPECT_NEAR(estimate.error_budget.noise(0) / expected.error_budget.noise(0),
              1, 0.05);
  EXPECT_NEAR(estimate.error_budget.noise(1) / expected.error_budget.noise(1),
              1, 0.05);
}

// The expected nu is the best of a scan of the dense residual along the edge E
// = E_max.
TEST(Bounded, KeepsBoundsOnYoungsModulus) {
  const Scene scene = NoisyScene(1e-3);
  const DegreesOfFreedom dofs(scene.supports);
  const Eigen::VectorXd q = scene.load_cases[0].displacement.reshaped();
  const Eigen::VectorXd a =
      (testing::DenseStiffness<double>(scene.mesh, testing::DenseDH()) *
       q)(dofs.free);
  const Eigen::VectorXd b =
      (testing::DenseStiffness<double>(scene.mesh, testing::DenseDJ()) *
       q)(dofs.free);
  const Eigen::VectorXd f = AssembleLoadCases(scene).col(0)(dofs.free);
  const auto residual = [&](double youngs, double nu) {
    return (a + nu * b - (1 + nu) * (1 - 2 * nu) / youngs * f).norm();
  };
  for (const bool upper : {true, false}) {
    const double bound = upper ? 4e4 : 6e4;
    double best_nu = 0;
    for (double nu = -0.9; nu < 0.4999; nu += 1e-5) {
      if (residual(bound, nu) < residual(bound, best_nu)) {
        best_nu = nu;
      }
    }
    const Estimate estimate =
        Bounded().Run(scene, upper ? WithBounds({}, {{}, bound})
                                   : WithBounds({}, {bound, {}}));
    EXPECT_NEAR(estimate.elasticity.youngs_modulus / bound, 1, 1e-12);
    EXPECT_NEAR(estimate.elasticity.poisson_ratio, best_nu, 2e-5);
    EXPECT_EQ(estimate.active_bounds,
              std::vector<std::string>{upper ? "youngs_max" : "youngs_min"});
    // A bound on the wrong side of the truth contradicts the data.
    EXPECT_FALSE(estimate.IsUsable());
  }
}

TEST(Bounded, TwoActiveBoundsLeaveNothingToEstimate) {
  const Estimate estimate =
      Bounded().Run(NoisyScene(1e-4), WithBounds({{}, 0.2}, {{}, 1e4}));
  EXPECT_EQ(estimate.active_bounds.size(), 2U);
  EXPECT_FALSE(estimate.IsUsable());
}

TEST(Bounded, ThePhysicalLimitIsNoAnswer) {
  Scene scene = SmallScene("organ");
  Measure({5e4, 0.49}, scene);
  AddNoise(0.3, 1, scene);
  ASSERT_GT(ClosedForm().Run(scene, {}).elasticity.poisson_ratio, 0.5);
  const Estimate estimate = Bounded().Run(scene, {});
  EXPECT_EQ(estimate.status, Status::kUnphysical);
}

TEST(Bounded, SaysWhenTheNoiseBiasesItWithinItsBounds) {
  Scene scene = NoisyScene(0.05);
  const Estimate estimate = Bounded().Run(scene, WithBounds({0.0, 0.49}, {}));
  EXPECT_FALSE(estimate.IsUsable());
  EXPECT_NE(estimate.message.find("noise"), std::string::npos);
}

TEST(Bounded, SaysWhenTheNoiseBiasesNuBesideABoundOnYoungsModulus) {
  for (int seed = 1; seed <= 8; ++seed) {
    Scene scene = SmallScene("organ");
    Measure({5e4, 0.3}, scene);
    AddNoise(0.05, seed, scene);
    for (const Bounds& bounds : {Bounds{4.95e4, 5.05e4}, Bounds{4.5e4, {}}}) {
      const Estimate estimate = Bounded().Run(scene, WithBounds({}, bounds));
      ASSERT_FALSE(estimate.active_bounds.empty());
      EXPECT_FALSE(estimate.IsUsable())
          << seed << ": nu = " << estimate.elasticity.poisson_ratio;
    }
  }
}

TEST(Bounded, RefusesALoss) {
  EstimatorOptions options;
  options.loss = Loss::kCauchy;
  EXPECT_THROWS_WITH(Bounded().Run(NoisyScene(0), options),
                     "use --estimator=reduced-fe");
}

}  // namespace
}  // namespace elastimate
