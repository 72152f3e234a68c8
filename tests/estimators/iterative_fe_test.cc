#include "elastimate/estimators/iterative_fe.h"

#include <gtest/gtest.h>

#include "tests/scenes.h"

namespace elastimate {
namespace {

using testing::Measure;
using testing::SmallScene;

TEST(IterativeFe, OneFactorizationServesAllLoadCases) {
  Scene three = testing::WithThreeForces(SmallScene("cuboid"));
  Measure({5e4, 0.3}, three);
  EstimatorOptions options;
  options.known_poisson_ratio = 0.3;
  int calls = 0;
  options.on_factorization = [&calls](int count) { EXPECT_EQ(count, ++calls); };
  const Estimate estimate = IterativeFe().Run(three, options);
  EXPECT_EQ(estimate.work.factorizations, 1);
  EXPECT_EQ(calls, 1);
  EXPECT_EQ(estimate.work.solves, 6);  // u and du/dnu of three cases.
}

TEST(IterativeFe, SaysWhenItRunsOutOfIterations) {
  Scene scene = SmallScene("organ");
  Measure({5e4, 0.49}, scene);
  testing::AddNoise(1e-2, 1, scene);  // Else virtual-fields is exact.
  EstimatorOptions options;
  options.max_iterations = 1;
  const Estimate estimate = IterativeFe().Run(scene, options);
  EXPECT_EQ(estimate.status, Status::kIterationLimit);
  EXPECT_FALSE(estimate.IsUsable());
  EXPECT_NE(estimate.message.find("1 iterations"), std::string::npos);
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

}  // namespace
}  // namespace elastimate
