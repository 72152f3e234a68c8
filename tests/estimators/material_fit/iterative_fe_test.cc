#include "elastimate/estimators/material_fit/iterative_fe.h"

#include <gtest/gtest.h>

#include "elastimate/estimators/material_fit/reduced_fe.h"
#include "tests/scenes.h"

namespace elastimate {
namespace {

using testing::Measure;
using testing::SmallScene;

TEST(IterativeFe, SaysWhenItRunsOutOfIterations) {
  Scene scene = SmallScene("organ");
  Measure({5e4, 0.49}, scene);
  testing::AddNoise(1e-2, 1, scene);  // Else virtual-fields is exact.
  EstimatorOptions options;
  options.max_iterations = 1;
  const Estimate estimate = IterativeFe().Run(scene, options);
  EXPECT_EQ(estimate.status, Status::kIterationLimit);
  EXPECT_FALSE(estimate.IsUsable());
  EXPECT_TRUE(estimate.Has(FindingCode::kNoConvergence));
}

// Bending has minima on several sides of its starts.
TEST(IterativeFe, FindsTheBestOfSeveralMinima) {
  for (const std::string& shape : testing::SmallSceneNames()) {
    for (const double nu : {-0.95, -0.9, -0.3, 0.1, 0.35, 0.495}) {
      SCOPED_TRACE(shape + ", nu " + std::to_string(nu));
      Scene scene = SmallScene(shape);
      Measure({5e4, nu}, scene);
      testing::AddNoise(1e-4, 1, scene);
      const Estimate estimate = IterativeFe().Run(scene, {});
      ASSERT_EQ(estimate.status, Status::kOk) << estimate.message;
      EXPECT_NEAR((estimate.elasticity.poisson_ratio - nu) /
                      *estimate.PoissonRatioStandardError(),
                  0, 5);
    }
  }
}

// Two searches for the same ends; a tenth of the interval is what interpolating
// between the looks of one of them may be off by.
TEST(IterativeFe, HasTheIntervalOfReducedFeOutsideItsStarts) {
  EstimatorOptions options;
  options.poisson_ratio = {-0.98, 0.4999};
  for (const std::string& shape : testing::SmallSceneNames()) {
    for (const double nu : {-0.965, -0.93, 0.499}) {
      for (const int seed : {1, 2, 3}) {
        SCOPED_TRACE(shape + ", nu " + std::to_string(nu) + ", seed " +
                     std::to_string(seed));
        Scene scene = SmallScene(shape);
        Measure({5e4, nu}, scene);
        testing::AddNoise(0.03, seed, scene);
        const Estimate iterative = IterativeFe().Run(scene, options);
        const Estimate reduced = ReducedFe().Run(scene, options);
        ASSERT_TRUE(iterative.poisson_ratio_interval &&
                    reduced.poisson_ratio_interval);
        const auto [lower, upper] = *reduced.poisson_ratio_interval;
        const double tolerance = 0.1 * (upper - lower);
        EXPECT_NEAR(iterative.poisson_ratio_interval->lower, lower, tolerance);
        EXPECT_NEAR(iterative.poisson_ratio_interval->upper, upper, tolerance);
      }
    }
  }
}

}  // namespace
}  // namespace elastimate
