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
  EstimatorOptions options;
  options.max_iterations = 1;
  const Estimate estimate = IterativeFe().Run(scene, options);
  EXPECT_EQ(estimate.status, Status::kIterationLimit);
  EXPECT_FALSE(estimate.IsUsable());
  EXPECT_NE(estimate.message.find("1 iterations"), std::string::npos);
}

}  // namespace
}  // namespace elastimate
