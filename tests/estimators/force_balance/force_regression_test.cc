#include "elastimate/estimators/force_balance/force_regression.h"

#include <gtest/gtest.h>

#include <cmath>

#include "elastimate/estimators/force_balance/force_residual.h"
#include "elastimate/estimators/interface/free_parameters.h"
#include "tests/scenes.h"

namespace elastimate {
namespace {

using testing::AddNoise;
using testing::Measure;
using testing::SmallScene;

// Whether the noise is known.
class FitWithoutBiasOfNoise : public ::testing::TestWithParam<bool> {};

TEST_P(FitWithoutBiasOfNoise, IsTheTruthInTheMean) {
  constexpr int kSeeds = 100;
  const Eigen::Vector2d truth(std::log(5e4), 0.3);
  Scene exact = SmallScene("organ");
  Measure({5e4, 0.3}, exact);
  Eigen::Array2d sum = Eigen::Array2d::Zero();
  Eigen::Array2d square_sum = Eigen::Array2d::Zero();
  Eigen::Array2d stated_square_sum = Eigen::Array2d::Zero();
  double variance_ratio_sum = 0;
  for (int seed = 1; seed <= kSeeds; ++seed) {
    Scene scene = exact;
    const double sd = AddNoise(0.005, seed, scene);
    double variance = sd * sd;
    if (GetParam()) {
      scene.load_cases[0].noise_sd = sd;
      variance = 1;  // Of the noise as the residual weights it.
    }
    const ForceScene prepared(scene);
    ForceResidual forces(prepared, scene);
    const FreeParameters free(scene, {});
    const UnbiasedFit fit = FitWithoutBias(free, truth, forces);
    const Eigen::Array2d error = fit.variables - truth;
    sum += error;
    square_sum += error.square();
    stated_square_sum +=
        CovarianceOf(fit, free, forces).value().diagonal().array();
    variance_ratio_sum += fit.noise_variance.value() / variance;
  }
  for (Eigen::Index i = 0; i < 2; ++i) {
    EXPECT_NEAR(sum(i) / kSeeds, 0, 4 * std::sqrt(square_sum(i)) / kSeeds) << i;
    // A root mean square has a relative standard deviation of sqrt(1 / 2 n).
    EXPECT_NEAR(std::sqrt(square_sum(i) / stated_square_sum(i)), 1,
                4 / std::sqrt(2.0 * kSeeds))
        << i;
  }
  // 240 free components: the variance has a relative sd of 0.091 for white
  // residuals, and up to twice that where a stiffness matrix colours them.
  EXPECT_NEAR(variance_ratio_sum / kSeeds, 1,
              4 * 2 * 0.091 / std::sqrt(kSeeds));
}

INSTANTIATE_TEST_SUITE_P(NoiseIsKnown, FitWithoutBiasOfNoise,
                         ::testing::Bool());

}  // namespace
}  // namespace elastimate
