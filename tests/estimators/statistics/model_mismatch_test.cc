#include "elastimate/estimators/statistics/model_mismatch.h"

#include <gtest/gtest.h>

#include <cmath>

#include "elastimate/estimators/displacement_fit/reduced_fe.h"
#include "elastimate/estimators/force_balance/virtual_fields.h"
#include "tests/scenes.h"

namespace elastimate {
namespace {

Estimate EstimateOf(double youngs_modulus, double poisson_ratio,
                    double youngs_error, double poisson_error) {
  Estimate estimate;
  estimate.elasticity = {youngs_modulus, poisson_ratio};
  estimate.covariance << youngs_error * youngs_error, 0, 0,
      poisson_error * poisson_error;
  return estimate;
}

TEST(ModelMismatch, IsHausmansStatistic) {
  const auto mismatch = FindModelMismatch(EstimateOf(110, 0.3, 5, 0.05),
                                          EstimateOf(100, 0.25, 3, 0.03));
  ASSERT_TRUE(mismatch.has_value());
  // Variances of the difference: 0.05^2 - 0.03^2 = 0.04^2, in ln E and in nu.
  const double expected =
      std::pow(std::log(1.1) / 0.04, 2) + std::pow(0.05 / 0.04, 2);
  EXPECT_NEAR(mismatch->statistic, expected, 1e-12 * expected);
  EXPECT_NEAR(mismatch->p_value, std::exp(-expected / 2), 1e-12);
  EXPECT_TRUE(mismatch->matters);
}

TEST(ModelMismatch, TakesTheRobustCovarianceWhereTheDifferenceIsNone) {
  const auto mismatch = FindModelMismatch(EstimateOf(101, 0.3, 2, 0.02),
                                          EstimateOf(100, 0.3, 3, 0.01));
  EXPECT_NEAR(mismatch->statistic, std::pow(std::log(1.01) / 0.02, 2), 1e-12);
}

TEST(ModelMismatch, IsEmptyWithoutCovariances) {
  EXPECT_FALSE(FindModelMismatch(EstimateOf(1, 0.3, NAN, 0.1),
                                 EstimateOf(1, 0.3, 0.1, 0.1))
                   .has_value());
  EXPECT_FALSE(FindModelMismatch(EstimateOf(-1, 0.3, 0.1, 0.1),
                                 EstimateOf(1, 0.3, 0.1, 0.1))
                   .has_value());
}

TEST(ModelMismatchStatistics, IsAsRareAsItSaysWhenTheModelHolds) {
  constexpr int kSeeds = 100;
  Scene exact = testing::SmallScene("cuboid");
  testing::Measure({5e4, 0.3}, exact);
  int num_below = 0;
  for (int seed = 1; seed <= kSeeds; ++seed) {
    Scene scene = exact;
    testing::AddNoise(0.005, seed, scene);
    const auto mismatch = FindModelMismatch(VirtualFields().Run(scene, {}),
                                            ReducedFe().Run(scene, {}));
    ASSERT_TRUE(mismatch.has_value());
    num_below += mismatch->p_value < 0.05;
  }
  // Binomial: mean 15, sd 3.8.
  EXPECT_NEAR(num_below, 0.05 * kSeeds, 4 * 2.2);
}

}  // namespace
}  // namespace elastimate
