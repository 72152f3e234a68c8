// Priors of parameters, combined with what the data say.

#include "elastimate/estimators/interface/priors.h"

#include <gtest/gtest.h>

#include <Eigen/LU>
#include <cmath>
#include <memory>
#include <random>

#include "tests/estimators/every_estimator.h"
#include "tests/scenes.h"

namespace elastimate {
namespace {

using testing::AddNoise;
using testing::kSmallNoise;
using testing::Measure;
using testing::SmallScene;

constexpr IsotropicElasticity kTruth = {5e4, 0.3};

Scene WithPriors(Scene scene, const std::vector<Prior>& priors) {
  Material material;
  material.priors = priors;
  scene.materials = {material};
  return scene;
}

Scene NoisyScene(double noise, int seed = 1) {
  Scene scene = SmallScene("cuboid");
  Measure(kTruth, scene);
  AddNoise(noise, seed, scene);
  return scene;
}

class PriorsOfEveryEstimator : public testing::EveryEstimator {};

// The oracle adds information, where the code subtracts covariance.
TEST_P(PriorsOfEveryEstimator, AddInformation) {
  const Scene scene = NoisyScene(kSmallNoise);
  const Estimate data = Run(scene);
  ASSERT_TRUE(data.IsUsable()) << data.message;
  const double value = data.elasticity.poisson_ratio;
  const double sd = *data.PoissonRatioStandardError();
  const Prior prior = {"poisson_ratio", value + sd, sd / 2};
  const Estimate both = Run(WithPriors(scene, {prior}));
  ASSERT_TRUE(both.IsUsable()) << both.message;
  const Eigen::Vector2d units(data.elasticity.youngs_modulus, 1);
  const Eigen::Matrix2d covariance = units.cwiseInverse().asDiagonal() *
                                     data.covariance *
                                     units.cwiseInverse().asDiagonal();
  Eigen::Matrix2d information = covariance.inverse();
  information(1, 1) += 1 / (prior.sd * prior.sd);
  const Eigen::Matrix2d expected = information.inverse();
  const Eigen::Vector2d change =
      expected * Eigen::Vector2d(0, sd / (prior.sd * prior.sd));
  EXPECT_NEAR(std::log(both.elasticity.youngs_modulus / units(0)), change(0),
              1e-9);
  EXPECT_NEAR(both.elasticity.poisson_ratio, value + change(1), 1e-9);
  EXPECT_NEAR(*both.PoissonRatioStandardError(), std::sqrt(expected(1, 1)),
              1e-6 * sd);
  EXPECT_NEAR(
      *both.YoungsModulusStandardError() / both.elasticity.youngs_modulus,
      std::sqrt(expected(0, 0)), 1e-6 * std::sqrt(expected(0, 0)));
  // The prior bears the share expected / sd^2 of the variance of nu.
  EXPECT_NEAR(both.error_budget.prior(1), expected(1, 1) / prior.sd, 1e-6 * sd);
  EXPECT_LT(both.error_budget.noise(1), data.error_budget.noise(1));
  EXPECT_FALSE(both.Has(FindingCode::kPriorContradicted));
}

TEST_P(PriorsOfEveryEstimator, AreSaidToContradictTheData) {
  const Scene scene = NoisyScene(kSmallNoise);
  const Estimate data = Run(scene);
  ASSERT_TRUE(data.IsUsable()) << data.message;
  const double error = *data.YoungsModulusStandardError();
  const Prior prior = {"youngs_modulus",
                       data.elasticity.youngs_modulus + 10 * error, error};
  const Estimate both = Run(WithPriors(scene, {prior}));
  ASSERT_TRUE(both.IsUsable()) << both.message;
  EXPECT_TRUE(both.Has(FindingCode::kPriorContradicted));
  EXPECT_GT(both.elasticity.youngs_modulus,
            data.elasticity.youngs_modulus + 4 * error);
  EXPECT_LT(both.elasticity.youngs_modulus, prior.value - 4 * error);
}

INSTANTIATE_TEST_SUITE_P(All, PriorsOfEveryEstimator,
                         ::testing::ValuesIn(EstimatorNames()),
                         testing::EstimatorTestName);

TEST(Priors, DetermineWhatNoiseHides) {
  const Scene scene = NoisyScene(1);
  const std::shared_ptr<const Estimator> estimator =
      MakeEstimator("reduced-fe");
  ASSERT_TRUE(
      estimator->Run(scene, {}).Has(FindingCode::kParametersUndetermined));
  const Estimate estimate =
      estimator->Run(WithPriors(scene, {{"poisson_ratio", 0.3, 0.02}}), {});
  ASSERT_TRUE(estimate.IsUsable()) << estimate.message;
  EXPECT_FALSE(estimate.Has(FindingCode::kParametersUndetermined));
  EXPECT_NEAR(*estimate.PoissonRatioStandardError(), 0.02, 2e-3);
  EXPECT_NEAR(estimate.error_budget.prior(1), 0.02, 2e-3);
  EXPECT_NEAR(estimate.elasticity.youngs_modulus, kTruth.youngs_modulus,
              3 * *estimate.YoungsModulusStandardError());
}

// The linear combination would go beyond 1/2.
TEST(Priors, KeepTheRangeAndTheBounds) {
  const Scene scene = NoisyScene(kSmallNoise);
  const Scene tight = WithPriors(scene, {{"youngs_modulus", 2e4, 1}});
  const Estimate estimate = MakeEstimator("reduced-fe")->Run(tight, {});
  ASSERT_TRUE(std::isfinite(estimate.elasticity.poisson_ratio));
  EXPECT_LE(estimate.elasticity.poisson_ratio, kLargestPoissonRatio);
  EXPECT_GE(estimate.elasticity.poisson_ratio, kSmallestPoissonRatio);
  EstimatorOptions options;
  options.poisson_ratio.upper = 0.31;
  const Estimate bounded =
      MakeEstimator("reduced-fe")
          ->Run(WithPriors(scene, {{"poisson_ratio", 0.4, 1e-6}}), options);
  EXPECT_LE(bounded.elasticity.poisson_ratio, 0.31);
}

TEST(Priors, OfNothingThatIsEstimatedLeaveAllAsItIs) {
  const Scene scene = NoisyScene(kSmallNoise);
  EstimatorOptions options;
  options.known_poisson_ratio = 0.3;
  const Estimate without = MakeEstimator("reduced-fe")->Run(scene, options);
  const Estimate with =
      MakeEstimator("reduced-fe")
          ->Run(WithPriors(scene, {{"poisson_ratio", 0.2, 1}}), options);
  EXPECT_EQ(with.elasticity.youngs_modulus, without.elasticity.youngs_modulus);
  EXPECT_EQ(with.error_budget.prior.size(), 0);
}

// The truth is drawn from the prior, as it says.
TEST(PriorStatistics, IntervalsHoldTruthsOfThePrior) {
  constexpr int kSeeds = 100;
  constexpr double kSd = 0.02;
  const std::shared_ptr<const Estimator> estimator =
      MakeEstimator("reduced-fe");
  std::mt19937_64 generator(7);
  std::normal_distribution<double> ratio(0.3, kSd);
  int covered = 0;
  double error = 0;
  double error_of_data = 0;
  for (int seed = 1; seed <= kSeeds; ++seed) {
    const double truth = ratio(generator);
    Scene scene = SmallScene("cuboid");
    Measure({5e4, truth}, scene);
    AddNoise(0.01, seed, scene);
    error_of_data +=
        *estimator->Run(scene, {}).PoissonRatioStandardError() / kSeeds;
    const Estimate estimate =
        estimator->Run(WithPriors(scene, {{"poisson_ratio", 0.3, kSd}}), {});
    ASSERT_TRUE(estimate.IsUsable()) << estimate.message;
    covered += std::abs(estimate.elasticity.poisson_ratio - truth) <
               1.96 * *estimate.PoissonRatioStandardError();
    error += *estimate.PoissonRatioStandardError() / kSeeds;
  }
  const double sd = std::sqrt(kSeeds * 0.95 * 0.05);
  EXPECT_GT(covered, 0.95 * kSeeds - 3.5 * sd);
  EXPECT_LT(error, error_of_data);
  EXPECT_LT(error, kSd);
}

}  // namespace
}  // namespace elastimate
