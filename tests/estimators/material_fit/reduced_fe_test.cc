#include "elastimate/estimators/material_fit/reduced_fe.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdio>
#include <random>

#include "elastimate/core/scene/finer_scene.h"
#include "elastimate/core/solvers/multigrid.h"
#include "elastimate/estimators/material_fit/iterative_fe.h"
#include "tests/scenes.h"
#include "tests/throws.h"

namespace elastimate {
namespace {

using testing::AddNoise;
using testing::BoxMesh;
using testing::HeldAtBottom;
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
  const double youngs_ratio =
      *actual.YoungsModulusStandardError() / youngs_error;
  const double poisson_ratio =
      *actual.PoissonRatioStandardError() / poisson_error;
  EXPECT_NEAR(youngs_ratio, 1, 1e-2);
  EXPECT_NEAR(poisson_ratio, 1, 1e-2);
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
        // Where the error of nu is large, another one is for values that may
        // fit as well.
        const bool is_error_large =
            reduced.PoissonRatioStandardError().value_or(1) > 0.02;
        EXPECT_LE(reduced.work.factorizations,
                  nu < 0.45 && !is_error_large ? 2 : 3);
      }
    }
  }
}

TEST(ReducedFe, EstimatesTheSameByMultigrid) {
  if (!HasMultigrid()) {
    GTEST_SKIP() << "built without PETSc";
  }
  EstimatorOptions direct;
  direct.solver = SolverKind::kCholesky;
  EstimatorOptions multigrid;
  multigrid.solver = SolverKind::kMultigrid;
  for (const std::string& shape : SmallSceneNames()) {
    for (const double nu : {-0.5, 0.3, 0.49}) {
      for (const double noise : {1e-3, 1e-1}) {
        SCOPED_TRACE(shape + ", nu " + std::to_string(nu) + ", noise " +
                     std::to_string(noise));
        Scene scene = SmallScene(shape);
        Measure({5e4, nu}, scene);
        AddNoise(noise, 1, scene);
        const Estimate expected = ReducedFe().Run(scene, direct);
        const Estimate estimate = ReducedFe().Run(scene, multigrid);
        if (expected.status == Status::kOk && expected.active_bounds.empty()) {
          ExpectSame(estimate, expected, 0.1);
        } else {
          EXPECT_EQ(estimate.status, expected.status);
        }
        EXPECT_EQ(estimate.work.factorizations, 0);
        EXPECT_GE(estimate.work.multigrid_set_ups, 1);
        EXPECT_GE(estimate.work.iterations, estimate.work.solves);
        EXPECT_EQ(expected.work.multigrid_set_ups, 0);
        EXPECT_EQ(expected.work.iterations, 0);
      }
    }
  }
}

// Quadratic elements are solved for by iterations over the linear elements of
// their vertices, where a fit has no certificate and descends from values
// across the range of nu.
TEST(ReducedFe, EstimatesTheSameOverTheVerticesOfQuadraticElements) {
  if (!HasMultigrid()) {
    GTEST_SKIP() << "built without PETSc";
  }
  EstimatorOptions direct;
  direct.solver = SolverKind::kCholesky;
  EstimatorOptions over_vertices;
  over_vertices.solver = SolverKind::kMultigrid;
  for (const double nu : {-0.5, 0.3, 0.45}) {
    SCOPED_TRACE(nu);
    Scene scene = FinerScene(SmallScene("cuboid"));
    ASSERT_EQ(scene.mesh.kind, ElementKind::kTet10);
    scene.origin = Origin::kComputed;
    Measure({5e4, nu}, scene);
    AddNoise(1e-2, 1, scene);
    const Estimate expected = ReducedFe().Run(scene, direct);
    const Estimate estimate = ReducedFe().Run(scene, over_vertices);
    EXPECT_EQ(estimate.element_order, 2);
    ExpectSame(estimate, expected, 0.1);
    EXPECT_EQ(estimate.work.factorizations, 0);
    EXPECT_GE(estimate.work.multigrid_set_ups, 1);
    EXPECT_GE(expected.work.factorizations, 1);
    EXPECT_EQ(expected.work.iterations, 0);
  }
}

// Multigrid lacks the soft bending modes of a slender bar, so that a residual
// may be small while most of the energy is missing.
TEST(ReducedFeLong, EstimatesTheSameByMultigridInASlenderBar) {
  if (!HasMultigrid()) {
    GTEST_SKIP() << "built without PETSc";
  }
  const Mesh bar = BoxMesh({3, 3, 200}, {0.1, 0.1, 6});
  Scene scene = HeldAtBottom(bar, bar, {0.1, 0, 0.05});
  Measure({5e4, 0.45}, scene);
  AddNoise(1e-3, 1, scene);
  EstimatorOptions options;
  options.solver = SolverKind::kCholesky;
  const Estimate expected = ReducedFe().Run(scene, options);
  options.solver = SolverKind::kMultigrid;
  ExpectSame(ReducedFe().Run(scene, options), expected, 0.1);
}

// What the condition number of the stiffness, 1 / (1 - 2 nu), leaves of the
// digits.
TEST(ReducedFe, KeepsItsDigitsNearOneHalf) {
  for (const std::string& shape : SmallSceneNames()) {
    for (const double nu : {0.49, 0.499, 0.4999}) {
      SCOPED_TRACE(shape + ", nu " + std::to_string(nu));
      Scene scene = SmallScene(shape);
      Measure({5e4, nu}, scene);
      const Estimate estimate = ReducedFe().Run(scene, {});
      ASSERT_EQ(estimate.status, Status::kOk) << estimate.message;
      EXPECT_NEAR(estimate.elasticity.youngs_modulus / 5e4, 1, 1e-6);
      EXPECT_NEAR((0.5 - estimate.elasticity.poisson_ratio) / (0.5 - nu), 1,
                  1e-5);
    }
  }
}

// At 20 % noise nu = 0.4999 cannot be told from 1/2.  The number of intervals
// that cover it is binomial: three standard deviations below 95 %.
// Which has to outlive what it prepares.
const ReducedFe kReducedFe;

TEST(PreparedReducedFe, BoundsNuOnOneSideNearOneHalf) {
  constexpr int kSeeds = 50;
  constexpr double kTrueNu = 0.4999;
  Scene exact = SmallScene("cuboid");
  Measure({5e4, kTrueNu}, exact);
  PreparedEstimator prepared = kReducedFe.Prepare(exact, {});
  int num_one_sided = 0;
  int num_covering = 0;
  for (int seed = 1; seed <= kSeeds; ++seed) {
    SCOPED_TRACE(seed);
    Scene scene = exact;
    AddNoise(0.2, seed, scene);
    const Estimate estimate = prepared.Run({scene.load_cases[0].displacement});
    ASSERT_EQ(estimate.status, Status::kOk) << estimate.message;
    ASSERT_TRUE(estimate.poisson_ratio_interval.has_value());
    const auto [lower, upper] = *estimate.poisson_ratio_interval;
    num_one_sided += upper == 0.5 ? 1 : 0;
    num_covering += lower <= kTrueNu && kTrueNu <= upper ? 1 : 0;
  }
  EXPECT_GE(num_one_sided, kSeeds / 2);
  EXPECT_GE(num_covering,
            kSeeds * (0.95 - 3 * std::sqrt(0.95 * 0.05 / kSeeds)));
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

// At nu = 0 a plate in bending hardly resists by its Poisson's ratio: E follows
// nu on a curve, along which it does not change to first order.
TEST(PreparedReducedFe, KnowsTheUncertaintyOfABentPlate) {
  constexpr int kSeeds = 60;
  const IsotropicElasticity truth = {5e4, 0};
  const Mesh mesh = testing::BoxMesh({1, 6, 6}, {0.1, 1, 1});
  Scene exact = testing::HeldAtBottom(mesh, mesh, {1, 0, 0});
  Measure(truth, exact);
  PreparedEstimator prepared = kReducedFe.Prepare(exact, {});
  int num_usable = 0;
  int num_covering = 0;
  double largest_score = 0;
  for (int seed = 1; seed <= kSeeds; ++seed) {
    Scene scene = exact;
    AddNoise(0.05, seed, scene);
    const Estimate estimate = prepared.Run({scene.load_cases[0].displacement});
    if (!estimate.IsUsable()) {
      continue;
    }
    ++num_usable;
    const double score =
        std::abs(estimate.elasticity.youngs_modulus - truth.youngs_modulus) /
        *estimate.YoungsModulusStandardError();
    largest_score = std::max(largest_score, score);
    num_covering += score < 1.96 ? 1 : 0;
  }
  std::printf("%d of %d usable, %d covering, largest score %.2f\n", num_usable,
              kSeeds, num_covering, largest_score);
  EXPECT_GE(num_usable, kSeeds / 4);
  EXPECT_GE(num_covering,
            num_usable * (0.95 - 3 * std::sqrt(0.95 * 0.05 / num_usable)));
  EXPECT_LT(largest_score, 5);
}

TEST(PreparedReducedFe, GivesWhatTheEstimatorGives) {
  Scene exact = testing::WithThreeForces(SmallScene("organ"));
  Measure({5e4, 0.3}, exact);
  for (const Loss loss : {Loss::kNone, Loss::kHuber}) {
    EstimatorOptions options;
    options.loss = loss;
    PreparedEstimator prepared = kReducedFe.Prepare(exact, options);
    for (int seed = 1; seed <= 10; ++seed) {
      SCOPED_TRACE(seed);
      Scene scene = exact;
      AddNoise(0.05, seed, scene);
      std::vector<Eigen::MatrixXd> displacements;
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

// 2 % of the nodes displaced by 20 standard deviations of the noise.
TEST(PreparedReducedFeStatistics, HardlyFeelsAFewGrossOutliers) {
  constexpr int kSeeds = 100;
  constexpr double kNoise = 0.01;
  Scene exact = SmallScene("organ");
  Measure({5e4, 0.3}, exact);
  const Eigen::Index num_nodes = exact.mesh.NumNodes();
  EstimatorOptions huber;
  huber.loss = Loss::kHuber;
  PreparedEstimator plain = kReducedFe.Prepare(exact, {});
  PreparedEstimator robust = kReducedFe.Prepare(exact, huber);
  double clean = 0;
  double contaminated = 0;
  double rejected = 0;
  const auto squared_error = [](const Estimate& estimate) {
    return std::pow(estimate.elasticity.youngs_modulus / 5e4 - 1, 2);
  };
  for (int seed = 1; seed <= kSeeds; ++seed) {
    Scene scene = exact;
    const double sd = AddNoise(kNoise, seed, scene);
    Eigen::MatrixXd& displacement = scene.load_cases[0].displacement;
    clean += squared_error(plain.Run({displacement}));
    std::mt19937_64 generator(seed);
    std::normal_distribution<double> normal;
    const int num_outliers = int(std::lround(0.02 * double(num_nodes)));
    for (int i = 0; i < num_outliers; ++i) {
      const Eigen::Index node = std::uniform_int_distribution<Eigen::Index>(
          16, num_nodes - 1)(generator);
      displacement.col(node) +=
          20 * sd *
          Eigen::Vector3d(normal(generator), normal(generator),
                          normal(generator))
              .normalized();
    }
    contaminated += squared_error(plain.Run({displacement}));
    rejected += squared_error(robust.Run({displacement}));
  }
  // The same noise is in all three: their ratios are far better known than
  // each.
  EXPECT_LT(std::sqrt(contaminated / clean), 1.15);
  EXPECT_LT(std::sqrt(rejected / clean), 1.15);
  std::printf("error with outliers over error without: %.3f, with huber %.3f\n",
              std::sqrt(contaminated / clean), std::sqrt(rejected / clean));
}

TEST(PreparedReducedFe, FurtherMeasurementsCostNoSolve) {
  Scene exact = SmallScene("organ");
  Measure({5e4, 0.3}, exact);
  PreparedEstimator prepared = kReducedFe.Prepare(exact, {});
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
  EXPECT_LE(factorizations, 2);
  // The largest of the first 50 and of all 100 estimates may differ.
  EXPECT_LE(solves, 4);
}

TEST(PreparedReducedFe, RefusesWhatDoesNotFit) {
  Scene scene = SmallScene("organ");
  Measure({5e4, 0.3}, scene);
  const Eigen::MatrixXd displacement = scene.load_cases[0].displacement;
  PreparedEstimator prepared = kReducedFe.Prepare(scene, {});
  EXPECT_THROWS_WITH(prepared.Run({}), "number of measured displacements is 0");
  EXPECT_THROWS_WITH(prepared.Run({displacement.leftCols(3)}), "3 columns");
  Eigen::MatrixXd broken = displacement;
  broken(1, 40) = std::nan("");
  EXPECT_THROWS_WITH(prepared.Run({broken}), "node 40 .y. .*not finite");
  EXPECT_THROWS_WITH(prepared.Run({0 * displacement}), "zero");
  EXPECT_NEAR(prepared.Run({displacement}).elasticity.youngs_modulus / 5e4, 1,
              1e-6);
  scene.supports.held.setConstant(false);
  EXPECT_THROWS_WITH(kReducedFe.Prepare(scene, {}), "without strain");
}

}  // namespace
}  // namespace elastimate
