#include "elastimate/estimators/reduced_fe.h"

#include <gtest/gtest.h>

#include <cmath>

#include "elastimate/estimators/iterative_fe.h"
#include "tests/scenes.h"
#include "tests/throws.h"

namespace elastimate {
namespace {

using testing::AddNoise;
using testing::Measure;
using testing::SmallScene;
using testing::SmallSceneNames;

// `tolerance` in standard errors.
void ExpectSame(const Estimate& actual, const Estimate& expected,
                double tolerance) {
  ASSERT_EQ(actual.status, Status::kOk) << actual.message;
  ASSERT_EQ(expected.status, Status::kOk) << expected.message;
  const double youngs_error = *expected.YoungsModulusStandardError();
  const double poisson_error = *expected.PoissonRatioStandardError();
  EXPECT_NEAR(actual.elasticity.youngs_modulus,
              expected.elasticity.youngs_modulus, tolerance * youngs_error);
  EXPECT_NEAR(actual.elasticity.poisson_ratio,
              expected.elasticity.poisson_ratio, tolerance * poisson_error);
  EXPECT_NEAR(*actual.YoungsModulusStandardError() / youngs_error, 1, 1e-2);
  EXPECT_NEAR(*actual.PoissonRatioStandardError() / poisson_error, 1, 1e-2);
}

TEST(ReducedFe, AgreesWithTheIterativeFitForFewFactorizations) {
  for (const std::string& shape : SmallSceneNames()) {
    for (const double nu : {-0.5, 0.0, 0.3, 0.44, 0.49}) {
      for (const double noise : {1e-3, 1e-2, 1e-1}) {
        SCOPED_TRACE(shape + ", nu " + std::to_string(nu) + ", noise " +
                     std::to_string(noise));
        Scene scene = SmallScene(shape);
        Measure({5e4, nu}, scene);
        AddNoise(noise, 1, scene);
        const Estimate reduced = ReducedFe().Run(scene, {});
        const Estimate iterative = IterativeFe().Run(scene, {});
        if (iterative.status == Status::kOk &&
            iterative.active_bounds.empty()) {
          ExpectSame(reduced, iterative, 0.1);
        } else {
          EXPECT_EQ(reduced.status, iterative.status);
        }
        EXPECT_LE(reduced.work.factorizations, nu < 0.45 ? 2 : 3);
      }
    }
  }
}

// A slender bar in bending has a second minimum, which a fit that starts on
// its side does not leave.
TEST(ReducedFe, FindsTheBestOfSeveralMinima) {
  for (const double nu : {-0.8, -0.3, 0.1, 0.35}) {
    Scene scene = SmallScene("bar");
    Measure({5e4, nu}, scene);
    const Estimate estimate = ReducedFe().Run(scene, {});
    ASSERT_EQ(estimate.status, Status::kOk) << estimate.message;
    EXPECT_NEAR(estimate.elasticity.poisson_ratio, nu, 1e-6);
  }
}

TEST(PreparedReducedFe, GivesWhatTheEstimatorGives) {
  Scene exact = testing::WithThreeForces(SmallScene("organ"));
  Measure({5e4, 0.3}, exact);
  for (const Loss loss : {Loss::kNone, Loss::kHuber}) {
    EstimatorOptions options;
    options.loss = loss;
    PreparedReducedFe prepared(exact, options);
    for (int seed = 1; seed <= 10; ++seed) {
      SCOPED_TRACE(seed);
      Scene scene = exact;
      AddNoise(0.05, seed, scene);
      std::vector<Eigen::Matrix3Xd> displacements;
      for (const LoadCase& load_case : scene.load_cases) {
        displacements.push_back(load_case.displacement);
      }
      const Estimate estimate = prepared.Run(displacements);
      const Estimate expected = ReducedFe().Run(scene, options);
      ExpectSame(estimate, expected, 0.1);
      EXPECT_EQ(estimate.estimator, "reduced-fe");
      EXPECT_NEAR(*estimate.displacement_residual,
                  *expected.displacement_residual, 1e-6);
      EXPECT_NEAR(*estimate.noise_sd / *expected.noise_sd, 1, 1e-3);
    }
  }
}

TEST(PreparedReducedFe, FurtherMeasurementsCostNoSolve) {
  Scene exact = SmallScene("organ");
  Measure({5e4, 0.3}, exact);
  PreparedReducedFe prepared(exact, {});
  int solves = 0;
  int factorizations = 0;
  for (int seed = 1; seed <= 100; ++seed) {
    Scene scene = exact;
    AddNoise(0.05, seed, scene);
    const Work work = prepared.Run({scene.load_cases[0].displacement}).work;
    factorizations += work.factorizations;
    if (seed > 50) {
      solves += work.solves;
    }
  }
  EXPECT_EQ(factorizations, 0);
  // The largest of the first 50 and of all 100 estimates may differ.
  EXPECT_LE(solves, 4);
}

TEST(PreparedReducedFe, RefusesWhatDoesNotFit) {
  Scene scene = SmallScene("organ");
  Measure({5e4, 0.3}, scene);
  const Eigen::Matrix3Xd displacement = scene.load_cases[0].displacement;
  PreparedReducedFe prepared(scene, {});
  EXPECT_THROWS_WITH(prepared.Run({}), "0 measured displacements for 1");
  EXPECT_THROWS_WITH(prepared.Run({displacement.leftCols(3)}), "3 columns");
  Eigen::Matrix3Xd broken = displacement;
  broken(1, 40) = std::nan("");
  EXPECT_THROWS_WITH(prepared.Run({broken}), "node 40 .y. .*not finite");
  EXPECT_THROWS_WITH(prepared.Run({0 * displacement}), "zero");
  EXPECT_NEAR(prepared.Run({displacement}).elasticity.youngs_modulus / 5e4, 1,
              1e-6);
  scene.supports.held.setConstant(false);
  EXPECT_THROWS_WITH(PreparedReducedFe(scene, {}), "without strain");
}

}  // namespace
}  // namespace elastimate
