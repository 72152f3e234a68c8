#include "elastimate/estimators/force_balance/force_residual.h"

#include <gtest/gtest.h>

#include <cmath>

#include "tests/scenes.h"

namespace elastimate {
namespace {

using testing::AddNoise;
using testing::Measure;
using testing::SmallScene;

// Whether the noise is known.
class UnbiasedPoissonRatio : public ::testing::TestWithParam<bool> {};

TEST_P(UnbiasedPoissonRatio, IsTheTruthInTheMeanWhereLeastSquaresIsNot) {
  constexpr int kSeeds = 100;
  constexpr double kNu = 0.3;
  Scene exact = SmallScene("organ");
  Measure({5e4, kNu}, exact);
  double biased_sum = 0;
  double sum = 0;
  double square_sum = 0;
  double stated_square_sum = 0;
  double variance_ratio_sum = 0;
  for (int seed = 1; seed <= kSeeds; ++seed) {
    Scene scene = exact;
    const double sd = AddNoise(0.005, seed, scene);
    double variance = sd * sd;
    if (GetParam()) {
      scene.load_cases[0].noise_sd = sd;
      variance = 1;  // Of the noise as the residual weights it.
    }
    const ForceResidual residual(scene);
    const double error = residual.UnbiasedPoissonRatio().value() - kNu;
    biased_sum += residual.PoissonRatio().value() - kNu;
    sum += error;
    square_sum += error * error;
    stated_square_sum +=
        std::pow(residual.UnbiasedPoissonRatioError().value(), 2);
    variance_ratio_sum +=
        residual
            .ResidualVariance(residual.ErrorsInVariablesPoissonRatio(), true)
            .value() /
        variance;
  }
  const double sd_of_mean = std::sqrt(square_sum) / kSeeds;
  EXPECT_GT(biased_sum / kSeeds, 8 * sd_of_mean);
  EXPECT_NEAR(sum / kSeeds, 0, 4 * sd_of_mean);
  // A root mean square has a relative standard deviation of sqrt(1 / 2 n).
  EXPECT_NEAR(std::sqrt(square_sum / stated_square_sum), 1,
              4 / std::sqrt(2.0 * kSeeds));
  // 240 free components: the variance has a relative sd of 0.091 for white
  // residuals, and up to twice that where a stiffness matrix colours them.
  EXPECT_NEAR(variance_ratio_sum / kSeeds, 1,
              4 * 2 * 0.091 / std::sqrt(kSeeds));
}

INSTANTIATE_TEST_SUITE_P(NoiseIsKnown, UnbiasedPoissonRatio, ::testing::Bool());

}  // namespace
}  // namespace elastimate
