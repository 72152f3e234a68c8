#include "elastimate/estimators/statistics/finer_specimen.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

namespace elastimate {
namespace {

constexpr double kManyRows = 1000;
constexpr SpecimenPrior kExpected = PriorOfSpecimen(1);

TEST(FinerSpecimen, IsSeenWhereTheChangeIsInTheResidual) {
  const FinerSpecimen finer =
      CompareWithFinerSpecimen(1.1, 0.01, kManyRows, 0, kExpected);
  EXPECT_NEAR(finer.probability, 1, 1e-9);
  EXPECT_NEAR(finer.Mean(), 1.1, 1e-3);
  EXPECT_NEAR(finer.Variance(), 1e-4, 1e-6);
}

TEST(FinerSpecimen, IsNoneWhereTheResidualLacksTheChange) {
  const FinerSpecimen own =
      CompareWithFinerSpecimen(0.01, 0.01, kManyRows, 0, kExpected);
  EXPECT_LT(own.probability, 0.02);
  EXPECT_LT(std::abs(own.Mean()), 1e-3);
  // Exact displacements, but for rounding.
  const FinerSpecimen exact =
      CompareWithFinerSpecimen(1e-13, 0, kManyRows, 0, kExpected);
  EXPECT_LT(exact.probability, 1e-5);
  EXPECT_LT(exact.Variance(), 1e-10);
}

TEST(FinerSpecimen, IsAsLikelyAsNotWhereNoiseHidesIt) {
  const FinerSpecimen hidden =
      CompareWithFinerSpecimen(3, 1e3, kManyRows, 0, kExpected);
  EXPECT_NEAR(hidden.probability, 0.5, 1e-3);
  // Between a share of 0 and one of 1 +- 0.45.
  EXPECT_NEAR(hidden.Mean(), 0.5, 1e-3);
  EXPECT_NEAR(hidden.Variance(), 0.25 + 0.2025 / 2, 1e-3);
}

TEST(FinerSpecimen, IsAsLikelyAsExpectedWhereNoiseHidesIt) {
  const SpecimenPrior expected = PriorOfSpecimen(2);
  const FinerSpecimen hidden =
      CompareWithFinerSpecimen(3, 1e3, kManyRows, 0, expected);
  EXPECT_NEAR(hidden.probability, expected.odds / (1 + expected.odds), 1e-3);
  EXPECT_NEAR(hidden.Mean(), 0.9 * 1.3, 1e-3);
}

// Where what is missed beside the change is twice what shows of it, a residual
// without it is that of either world.
TEST(FinerSpecimen, IsNotExcludedByWhatDoesNotShow) {
  const FinerSpecimen shown =
      CompareWithFinerSpecimen(0, 0.1, kManyRows, 0, kExpected);
  EXPECT_LT(shown.probability, 0.05);
  const FinerSpecimen hidden =
      CompareWithFinerSpecimen(0, 0.1, kManyRows, 2, kExpected);
  EXPECT_GT(hidden.probability, 0.1);
  EXPECT_LT(hidden.probability, 0.5);
  // The share is what is expected, within the deviation of that.
  EXPECT_NEAR(hidden.share, kExpected.share, 0.1);
  EXPECT_NEAR(hidden.share_variance, 0.45 * 0.45, 0.02);
}

// More noise never makes the uncertainty of the share smaller than sampling
// does: on the mean over measurements of either world.
TEST(FinerSpecimen, GrowsLessCertainWithNoise) {
  for (const double truth : {0.0, 1.0}) {
    double last = 0;
    for (const double noise : {0.01, 0.03, 0.1, 0.3, 1.0}) {
      std::mt19937_64 generator(1);
      std::normal_distribution<double> normal;
      double sum = 0;
      for (int seed = 0; seed < 200; ++seed) {
        sum += CompareWithFinerSpecimen(truth + noise * normal(generator),
                                        noise, kManyRows, 0, kExpected)
                   .Variance();
      }
      EXPECT_GT(sum, last) << truth << ", " << noise;
      last = sum;
    }
  }
}

// What it says of the share is right in the worlds that it expects.
TEST(FinerSpecimenStatistics, CoversTheShare) {
  constexpr int kSeeds = 4000;
  for (const int order : {1, 2}) {
    const SpecimenPrior expected = PriorOfSpecimen(order);
    for (const double noise : {0.02, 0.2, 1.0}) {
      std::mt19937_64 generator(2);
      std::normal_distribution<double> normal;
      std::bernoulli_distribution is_finer(expected.odds / (1 + expected.odds));
      double square_sum = 0;
      for (int seed = 0; seed < kSeeds; ++seed) {
        const double of_finer = expected.share + 0.45 * normal(generator);
        const double truth = is_finer(generator) ? of_finer : 0;
        const FinerSpecimen finer = CompareWithFinerSpecimen(
            truth + noise * normal(generator), noise, kManyRows, 0, expected);
        square_sum += std::pow(truth - finer.Mean(), 2) / finer.Variance();
      }
      // The mean square of standardised errors of a Bayesian mean is 1; a
      // mixture of kurtosis up to 30 has it within these bounds.
      EXPECT_NEAR(square_sum / kSeeds, 1, 4 * std::sqrt(30.0 / kSeeds))
          << order << ", " << noise;
    }
  }
}

}  // namespace
}  // namespace elastimate
