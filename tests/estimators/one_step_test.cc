#include "elastimate/estimators/one_step.h"

#include <gtest/gtest.h>

#include <variant>

#include "elastimate/estimators/iterative_fe.h"
#include "tests/scenes.h"
#include "tests/throws.h"

namespace elastimate {
namespace {

using testing::AddNoise;
using testing::BoxMesh;
using testing::HeldAtBottom;
using testing::Measure;
using testing::SmallScene;

TEST(OneStep, IsAsGoodAsTheIterativeFit) {
  for (const std::string shape : {"cuboid", "organ"}) {
    for (const double nu : {0.0, 0.3, 0.45}) {
      for (const double noise : {1e-3, 1e-2, 5e-2}) {
        SCOPED_TRACE(shape + ", nu " + std::to_string(nu) + ", noise " +
                     std::to_string(noise));
        Scene scene = SmallScene(shape);
        Measure({5e4, nu}, scene);
        AddNoise(noise, 1, scene);
        const Estimate step = OneStep().Run(scene, {});
        const Estimate fit = IterativeFe().Run(scene, {});
        ASSERT_EQ(step.status, Status::kOk) << step.message;
        // Half a standard error of nu is what a step may miss.
        EXPECT_NEAR(step.elasticity.poisson_ratio, fit.elasticity.poisson_ratio,
                    0.5 * *fit.PoissonRatioStandardError());
        EXPECT_NEAR(step.elasticity.youngs_modulus,
                    fit.elasticity.youngs_modulus,
                    0.5 * *fit.YoungsModulusStandardError());
        EXPECT_LE(step.work.factorizations, 3);
        EXPECT_LT(step.work.factorizations, fit.work.factorizations);
      }
    }
  }
}

TEST(OneStep, TakesOneFactorizationWhereVirtualFieldsAreClose) {
  Scene scene = SmallScene("cuboid");
  Measure({5e4, 0.3}, scene);
  AddNoise(1e-2, 1, scene);
  const Estimate estimate = OneStep().Run(scene, {});
  EXPECT_EQ(estimate.work.factorizations, 1);
  EXPECT_EQ(estimate.work.solves, 2);
}

// A slender bar, pulled and bent at its end, whose noise leaves nu open: some
// steps end next to -1, where nothing has settled.
TEST(OneStep, DoesNotSettleAtAPole) {
  const Mesh mesh = testing::BoxMesh({1, 1, 60}, {0.1, 0.1, 6});
  Scene scene = testing::HeldAtBottom(mesh, mesh, Eigen::Vector3d::Zero());
  Eigen::Matrix3Xd force = Eigen::Matrix3Xd::Zero(3, mesh.NumNodes());
  force.rightCols(4).colwise() = Eigen::Vector3d(-0.25, 0, 0.5);
  scene.load_cases[0].loads = {NodalForces{force}};
  Measure({1e4, 0.3}, scene);
  for (const int seed : {4, 22, 57}) {
    SCOPED_TRACE(seed);
    Scene noisy = scene;
    AddNoise(0.03, seed, noisy);
    const Estimate estimate = OneStep().Run(noisy, {});
    if (estimate.IsUsable()) {
      EXPECT_NEAR(estimate.elasticity.poisson_ratio, 0.3,
                  5 * *estimate.PoissonRatioStandardError());
    }
  }
}

TEST(OneStep, StartsWithoutVirtualFieldsWhereNotAllIsObserved) {
  Scene scene = SmallScene("organ");
  Measure({5e4, 0.4}, scene);
  AddNoise(1e-3, 1, scene);
  scene.load_cases[0].observed =
      ComponentMask::Constant(3, scene.mesh.NumNodes(), true);
  scene.load_cases[0].observed.row(1).setConstant(false);
  scene.load_cases[0].displacement.row(1).setConstant(1e3);
  const Estimate step = OneStep().Run(scene, {});
  const Estimate fit = IterativeFe().Run(scene, {});
  ASSERT_EQ(step.status, Status::kOk) << step.message;
  EXPECT_NEAR(step.elasticity.poisson_ratio, fit.elasticity.poisson_ratio,
              0.5 * *fit.PoissonRatioStandardError());
}

TEST(OneStep, RefusesWhatItCannotHonour) {
  Scene scene = SmallScene("cuboid");
  Measure({5e4, 0.3}, scene);
  EstimatorOptions bounds;
  bounds.poisson_ratio.upper = 0.4;
  EXPECT_THROWS_WITH(OneStep().Run(scene, bounds), "use reduced-fe");
  EstimatorOptions loss;
  loss.loss = Loss::kHuber;
  EXPECT_THROWS_WITH(OneStep().Run(scene, loss), "use reduced-fe");
  scene.supports.held.setConstant(false);
  EXPECT_THROWS_WITH(OneStep().Run(scene, {}), "without strain");
}

// E is known far better than nu in a slender bar, and what a step in nu misses
// is soon much for it.
TEST(OneStepStatistics, AgreesOnEWithTheIterativeFitOfABar) {
  const Mesh mesh = BoxMesh({2, 2, 20}, {1, 1, 10});
  for (const double stretching : {0, 2, 20}) {
    for (int seed = 1; seed <= 20; ++seed) {
      Scene scene = HeldAtBottom(mesh, mesh, {-1, 0, stretching});
      // At the end only.
      std::get<NodalForces>(scene.load_cases[0].loads[0])
          .force.leftCols(9 * 20)
          .setZero();
      Measure({1e4, 0.3}, scene);
      AddNoise(0.01, seed, scene);
      const Estimate step = OneStep().Run(scene, {});
      const Estimate fit = IterativeFe().Run(scene, {});
      ASSERT_TRUE(step.IsUsable() && fit.IsUsable()) << seed;
      EXPECT_NEAR(step.elasticity.youngs_modulus, fit.elasticity.youngs_modulus,
                  0.25 * *step.YoungsModulusStandardError())
          << seed;
    }
  }
}

}  // namespace
}  // namespace elastimate
