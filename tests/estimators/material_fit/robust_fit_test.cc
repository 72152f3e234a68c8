// Fits with a loss say as much of the elements as fits without one.

#include <gtest/gtest.h>

#include <cmath>
#include <memory>
#include <random>
#include <string>
#include <tuple>

#include "elastimate/core/equilibrium/simulated_measurement.h"
#include "elastimate/estimators/registry.h"
#include "tests/shapes.h"

namespace elastimate {
namespace {

constexpr IsotropicElasticity kTruth = {5e4, 0.3};

// Displacements of quadratic elements, with outliers.
Scene FinerShapeWithOutliers(const std::string& shape, const std::string& load,
                             int seed) {
  Scene scene = testing::ShapeScene(shape, load);
  MeasureInFinerWorld(kTruth, scene);
  MeasurementErrors errors;
  errors.relative_noise = 0.01;
  errors.law = NoiseLaw::kGaussian;
  errors.outliers = 0.03;
  std::mt19937_64 generator(seed);
  AddErrors(errors, scene.mesh.nodes, scene.supports.held, generator,
            scene.load_cases[0].displacement);
  return scene;
}

class RobustFitStatistics
    : public ::testing::TestWithParam<std::tuple<std::string, Loss>> {};

// Linear elements are 20 to 300 % too stiff here.
TEST_P(RobustFitStatistics, IsRefusedOrHoldsWhatLinearElementsMiss) {
  const auto& [estimator, loss] = GetParam();
  EstimatorOptions options;
  options.loss = loss;
  int num_usable = 0;
  for (const std::string shape : {"dumbbell", "ring", "tree", "bracket"}) {
    for (const std::string load : {"torsion", "bending"}) {
      for (int seed = 1; seed <= 3; ++seed) {
        SCOPED_TRACE(shape + ", " + load + ", " + std::to_string(seed));
        const Scene scene = FinerShapeWithOutliers(shape, load, seed);
        const Estimate estimate = MakeEstimator(estimator)->Run(scene, options);
        if (!estimate.IsUsable()) {
          continue;
        }
        ++num_usable;
        EXPECT_LT(std::abs(estimate.elasticity.youngs_modulus -
                           kTruth.youngs_modulus),
                  3 * estimate.YoungsModulusStandardError().value_or(0));
        if (estimate.poisson_ratio_interval) {
          EXPECT_LT(estimate.poisson_ratio_interval->lower,
                    kTruth.poisson_ratio + 0.03);
          EXPECT_GT(estimate.poisson_ratio_interval->upper,
                    kTruth.poisson_ratio - 0.03);
        } else {
          EXPECT_LT(std::abs(estimate.elasticity.poisson_ratio -
                             kTruth.poisson_ratio),
                    3 * estimate.PoissonRatioStandardError().value_or(0));
        }
      }
    }
  }
  RecordProperty("usable", num_usable);
}

INSTANTIATE_TEST_SUITE_P(
    Estimators, RobustFitStatistics,
    ::testing::Combine(::testing::Values("reduced-fe", "iterative-fe"),
                       ::testing::Values(Loss::kHuber, Loss::kCauchy)));

// On the elements of the data, outliers and a nu next to 1/2 leave the interval
// what it is without them.
TEST(RobustFit, ProfilesNextToOneHalf) {
  Scene scene = testing::ShapeScene("wedge", "tension");
  Measure({5e4, 0.497}, scene);
  MeasurementErrors errors;
  errors.relative_noise = 0.03;
  errors.law = NoiseLaw::kGaussian;
  std::mt19937_64 generator(1);
  AddErrors(errors, scene.mesh.nodes, scene.supports.held, generator,
            scene.load_cases[0].displacement);
  const Estimate squares = MakeEstimator("reduced-fe")->Run(scene, {});
  ASSERT_TRUE(squares.poisson_ratio_interval) << squares.message;
  EstimatorOptions options;
  options.loss = Loss::kHuber;
  for (const std::string estimator : {"reduced-fe", "iterative-fe"}) {
    SCOPED_TRACE(estimator);
    const Estimate robust = MakeEstimator(estimator)->Run(scene, options);
    ASSERT_TRUE(robust.poisson_ratio_interval) << robust.message;
    const double width = squares.poisson_ratio_interval->upper -
                         squares.poisson_ratio_interval->lower;
    // Huber's loss is 95 % as efficient as least squares.
    EXPECT_NEAR(robust.poisson_ratio_interval->lower,
                squares.poisson_ratio_interval->lower, 0.4 * width);
    EXPECT_NEAR(robust.poisson_ratio_interval->upper,
                squares.poisson_ratio_interval->upper, 0.4 * width);
  }
}

}  // namespace
}  // namespace elastimate
