#include "elastimate/estimators/element_order.h"

#include <gtest/gtest.h>

#include <cmath>

#include "elastimate/estimators/auto.h"
#include "tests/regions.h"
#include "tests/scenes.h"

namespace elastimate {
namespace {

constexpr double kNoiseSd = 1e-3;
const IsotropicElasticity kByLinear = {900, 0.25};
const IsotropicElasticity kByQuadratic = {1000, 0.3};

// Of which all nodes are observed, with a noise that is given.
Scene GivenScene() {
  Scene scene = testing::BlockUnderTraction({2, 2, 2}, {1, 1, 1});
  testing::Measure({1000, 0.3}, scene);
  scene.load_cases[0].noise_sd = kNoiseSd;
  return scene;
}

// Whose square sum of residuals is that of `square_sum` rows of noise.
Estimate FitOf(const Scene& scene, int order,
               const IsotropicElasticity& elasticity, double square_sum) {
  Estimate estimate;
  estimate.element_order = order;
  estimate.elasticity = elasticity;
  estimate.bounded_residual = std::sqrt(square_sum) * kNoiseSd /
                              scene.load_cases[0].displacement.norm();
  estimate.covariance = Eigen::Vector2d(400, 1e-4).asDiagonal();
  estimate.discretization_error = 0.01;
  estimate.poisson_ratio_discretization_error = 0.005;
  estimate.poisson_ratio_interval = {0.28, 0.32};
  return estimate;
}

// The probability of linear elements that is held.
double HeldProbability(const Scene& scene, const Estimate& linear,
                       const Estimate& quadratic) {
  Estimate held = quadratic;
  OrderComparison(scene, {}, linear, quadratic).HoldLinear(held);
  const double change =
      linear.elasticity.youngs_modulus - quadratic.elasticity.youngs_modulus;
  return (held.covariance(0, 0) - quadratic.covariance(0, 0)) /
         (change * change);
}

TEST(OrderComparison, WeighsBothByTheirLikelihoods) {
  const Scene scene = GivenScene();
  const Estimate quadratic = FitOf(scene, 2, kByQuadratic, 60);
  for (const double gain : {-8.0, -2.0, 0.0, 3.0, 8.0}) {
    const Estimate linear = FitOf(scene, 1, kByLinear, 60 - gain);
    EXPECT_NEAR(HeldProbability(scene, linear, quadratic),
                1 / (1 + std::exp(-gain / 2)), 1e-9)
        << gain;
    const OrderComparison compared(scene, {}, linear, quadratic);
    EXPECT_EQ(compared.IsLinearLikely(), gain == 8);
    EXPECT_EQ(compared.IsQuadraticLikely(), gain == -8);
    EXPECT_FALSE(compared.IsLinearFarBetter());
    EXPECT_FALSE(compared.IsQuadraticFarBetter());
  }
  const Estimate far_worse = FitOf(scene, 1, kByLinear, 90);
  EXPECT_TRUE(
      OrderComparison(scene, {}, far_worse, quadratic).IsQuadraticFarBetter());
}

TEST(OrderComparison, EstimatesTheNoiseThatIsNotGiven) {
  Scene scene = GivenScene();
  scene.load_cases[0].noise_sd.reset();
  const double redundancy =
      static_cast<double>(scene.load_cases[0].displacement.size()) - 2 -
      static_cast<double>(scene.supports.held.count());
  const Estimate quadratic = FitOf(scene, 2, kByQuadratic, 60);
  const Estimate linear = FitOf(scene, 1, kByLinear, 57);
  EXPECT_NEAR(HeldProbability(scene, linear, quadratic),
              1 / (1 + std::pow(57.0 / 60, redundancy / 2)), 1e-9);
}

// What neighbours share in both residuals is no evidence for either.
TEST(OrderComparison, CountsWhatNeighboursShareOnce) {
  const Scene scene = GivenScene();
  Estimate quadratic = FitOf(scene, 2, kByQuadratic, 60);
  Estimate linear = FitOf(scene, 1, kByLinear, 54);
  linear.residual_correlation = 0.8;
  EXPECT_NEAR(HeldProbability(scene, linear, quadratic), 1 / (1 + std::exp(-3)),
              1e-9);
  quadratic.residual_correlation = 0.5;
  EXPECT_NEAR(HeldProbability(scene, linear, quadratic), 1 / (1 + std::exp(-1)),
              1e-9);
}

TEST(OrderComparison, HoldsWhatLinearElementsSayUncorrected) {
  const Scene scene = GivenScene();
  Estimate linear = FitOf(scene, 1, {990, 0.29}, 60);
  linear.discretization_correction = Eigen::Vector2d(0.1, 0.04);
  Estimate held = FitOf(scene, 2, kByQuadratic, 60);
  const OrderComparison compared(scene, {}, linear, held);
  EXPECT_NEAR(compared.ByLinear().youngs_modulus, 900, 1e-9);
  EXPECT_NEAR(compared.ByLinear().poisson_ratio, 0.25, 1e-12);
  compared.HoldLinear(held);
  // Both are as likely: half of the squares of 100 and of 0.05.
  EXPECT_NEAR(held.covariance(0, 0), 400 + 5000, 1e-9);
  EXPECT_NEAR(held.covariance(1, 1), 1e-4 + 0.00125, 1e-12);
  EXPECT_NEAR(held.covariance(0, 1), 2.5, 1e-12);
  EXPECT_NEAR(*held.discretization_error, std::hypot(0.01, std::sqrt(0.005)),
              1e-12);
  EXPECT_NEAR(*held.poisson_ratio_discretization_error,
              std::hypot(0.005, std::sqrt(0.00125)), 1e-12);
  const double distance = std::hypot(0.02, 1.96 * std::sqrt(0.00125));
  EXPECT_NEAR(held.poisson_ratio_interval->lower, 0.3 - distance, 1e-3);
  EXPECT_NEAR(held.poisson_ratio_interval->upper, 0.3 + distance, 1e-3);
}

// Under noise that hides which elements made the displacements, of which the
// linear ones are too stiff, `auto` is right about either.
TEST(OrderComparisonStatistics, KeepsAutoHonestAboutEither) {
  const Mesh mesh = testing::BoxMesh({4, 4, 8}, {0.3, 0.3, 0.8});
  Scene bar = testing::HeldAtBottom(mesh, mesh, Eigen::Vector3d::Zero());
  bar.load_cases[0].loads = {BodyForce{Eigen::Vector3d(1e4, 0, 2e4)}};
  EstimatorOptions options;
  options.known_poisson_ratio = 0.3;
  int num_in_doubt = 0;
  for (const bool is_specimen : {false, true}) {
    Scene exact = bar;
    if (is_specimen) {
      testing::MeasureInFinerWorld({1e7, 0.3}, exact);
    } else {
      testing::Measure({1e7, 0.3}, exact);
    }
    for (int seed = 1; seed <= 5; ++seed) {
      Scene measured = exact;
      testing::AddNoise(0.5, seed, measured);
      const Estimate estimate = Auto().Run(measured, options);
      ASSERT_EQ(estimate.status, Status::kOk) << estimate.message;
      num_in_doubt += estimate.Has(FindingCode::kLinearElementsFitAsWell);
      // Chance puts one of 10 beyond in one run of 200.
      EXPECT_LT(std::abs(estimate.elasticity.youngs_modulus - 1e7),
                3.5 * *estimate.YoungsModulusStandardError())
          << is_specimen << ", " << seed;
    }
  }
  EXPECT_GE(num_in_doubt, 1);
}

}  // namespace
}  // namespace elastimate
