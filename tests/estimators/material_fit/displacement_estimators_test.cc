// What the estimators promise that fit the displacements by least squares.

#include <gtest/gtest.h>

#include <Eigen/LU>
#include <cmath>
#include <random>

#include "elastimate/core/scene/degrees_of_freedom.h"
#include "elastimate/core/scene/loads.h"
#include "elastimate/estimators/registry.h"
#include "tests/dense_reference.h"
#include "tests/scenes.h"
#include "tests/throws.h"

namespace elastimate {
namespace {

using testing::AddNoise;
using testing::DenseFreeDisplacement;
using testing::Measure;
using testing::SmallScene;

class DisplacementEstimators
    : public ::testing::TestWithParam<std::string_view> {
 protected:
  Estimate Run(const Scene& scene, const EstimatorOptions& options) const {
    return MakeEstimator(GetParam())->Run(scene, options);
  }
};

TEST_P(DisplacementEstimators, RecoversTheTruthFromItsDefaultStart) {
  for (const double nu : {0.0, 0.1, 0.2, 0.3, 0.4, 0.45, 0.48, 0.49}) {
    SCOPED_TRACE(nu);
    Scene scene = SmallScene("organ");
    Measure({5e4, nu}, scene);
    const Estimate estimate = Run(scene, {});
    ASSERT_EQ(estimate.status, Status::kOk) << estimate.message;
    EXPECT_NEAR(estimate.elasticity.youngs_modulus / 5e4, 1, 1e-6);
    EXPECT_NEAR(estimate.elasticity.poisson_ratio, nu, 1e-6);
    EXPECT_LT(*estimate.displacement_residual, 1e-6);
  }
}

// The sum of squares hardly depends on nu, but for a dip next to 1/2 that has a
// curvature of its own.
TEST_P(DisplacementEstimators, ALockedPlateDoesNotDetermineNu) {
  constexpr double kThickness = 1e-4;
  Scene scene;
  scene.mesh = testing::BoxMesh({8, 8, 1}, {1, 1, kThickness});
  const Eigen::Index num_nodes = scene.mesh.NumNodes();
  scene.supports.held = ComponentMask::Constant(3, num_nodes, false);
  scene.supports.displacement = Eigen::MatrixXd::Zero(3, num_nodes);
  NodalForces force{Eigen::MatrixXd::Zero(3, num_nodes)};
  for (Eigen::Index node = 0; node < num_nodes; ++node) {
    scene.supports.held.col(node) = scene.mesh.nodes(0, node) == 0;
    force.force(2, node) = scene.mesh.nodes(0, node) == 1 ? 1 : 0;
  }
  scene.load_cases.resize(1);
  scene.load_cases[0].loads.emplace_back(force);
  Measure({1e9, 0.3}, scene);
  const Scene exact = scene;
  for (int seed = 1; seed <= 6; ++seed) {
    SCOPED_TRACE(seed);
    scene = exact;
    AddNoise(0.01, seed, scene);
    const Estimate estimate = Run(scene, {});
    if (estimate.IsUsable()) {
      EXPECT_FALSE(estimate.parameters[1].IsDetermined());
      const Interval& interval = *estimate.parameters[0].interval;
      EXPECT_LT(interval.lower, 1e9);
      EXPECT_GT(interval.upper, 1e9);
      if (estimate.shear_modulus) {
        EXPECT_NEAR(estimate.shear_modulus->value, 1e9 / 2.6,
                    2 * estimate.shear_modulus->standard_error);
      }
    }
  }
}

// The Cramer-Rao bound from finite differences of the dense solution.
TEST_P(DisplacementEstimators, StandardErrorsAreTheCramerRaoBound) {
  Scene scene = SmallScene("organ");
  Measure({5e4, 0.3}, scene);
  const double sd = AddNoise(1e-4, 3, scene);
  scene.load_cases[0].noise_sd = sd;
  const double step = 1e-4;
  Eigen::MatrixXd sensitivities(DegreesOfFreedom(scene.supports).NumFree(), 2);
  sensitivities << (DenseFreeDisplacement(scene, {5e4 * (1 + step), 0.3}, 0) -
                    DenseFreeDisplacement(scene, {5e4 * (1 - step), 0.3}, 0)) /
                       (2 * step * 5e4),
      (DenseFreeDisplacement(scene, {5e4, 0.3 + step}, 0) -
       DenseFreeDisplacement(scene, {5e4, 0.3 - step}, 0)) /
          (2 * step);
  const Eigen::Matrix2d bound =
      sd * sd * (sensitivities.transpose() * sensitivities).inverse();
  const Estimate estimate = Run(scene, {});
  EXPECT_NEAR(*estimate.YoungsModulusStandardError() / std::sqrt(bound(0, 0)),
              1, 1e-3);
  EXPECT_NEAR(*estimate.PoissonRatioStandardError() / std::sqrt(bound(1, 1)), 1,
              1e-3);
  EXPECT_NEAR(*estimate.Correlation(),
              bound(0, 1) / std::sqrt(bound(0, 0) * bound(1, 1)), 1e-3);
  const double cosine = std::abs(
      sensitivities.col(0).normalized().dot(sensitivities.col(1).normalized()));
  EXPECT_NEAR(*estimate.identifiability_angle, std::acos(cosine), 1e-3);
}

TEST_P(DisplacementEstimators, StaysUsableUnderNoiseThatRuinsTheClosedForm) {
  constexpr int kSeeds = 30;
  Scene exact = SmallScene("organ");
  Measure({5e4, 0.3}, exact);
  double chi_square = 0;
  for (int seed = 1; seed <= kSeeds; ++seed) {
    Scene scene = exact;
    AddNoise(0.1, seed, scene);
    const Estimate estimate = Run(scene, {});
    ASSERT_EQ(estimate.status, Status::kOk) << estimate.message;
    chi_square += std::pow((estimate.elasticity.youngs_modulus - 5e4) /
                               *estimate.YoungsModulusStandardError(),
                           2);
  }
  // chi^2 of 30 degrees of freedom: mean 30, sd 7.7.
  EXPECT_NEAR(chi_square, kSeeds, 4 * std::sqrt(2.0 * kSeeds));
}

TEST_P(DisplacementEstimators, UsesWhatWasObserved) {
  Scene scene = SmallScene("organ");
  Measure({5e4, 0.3}, scene);
  // Only x and z at every third node; the rest is garbage.
  scene.load_cases[0].observed =
      ComponentMask::Constant(3, scene.mesh.NumNodes(), false);
  for (Eigen::Index node = 0; node < scene.mesh.NumNodes(); ++node) {
    if (node % 3 == 0) {
      scene.load_cases[0].observed.col(node) << true, false, true;
    }
    for (int i = 0; i < 3; ++i) {
      if (!scene.load_cases[0].observed(i, node)) {
        scene.load_cases[0].displacement(i, node) = 1e3;
      }
    }
  }
  const Estimate estimate = Run(scene, {});
  ASSERT_EQ(estimate.status, Status::kOk) << estimate.message;
  EXPECT_NEAR(estimate.elasticity.youngs_modulus / 5e4, 1, 1e-6);
  EXPECT_NEAR(estimate.elasticity.poisson_ratio, 0.3, 1e-6);
}

TEST_P(DisplacementEstimators, KeepsBounds) {
  Scene scene = SmallScene("organ");
  Measure({5e4, 0.3}, scene);
  AddNoise(1e-3, 1, scene);
  EstimatorOptions options;
  options.poisson_ratio = {0.35, 0.45};
  const Estimate estimate = Run(scene, options);
  ASSERT_EQ(estimate.status, Status::kOk) << estimate.message;
  EXPECT_NEAR(estimate.elasticity.poisson_ratio, 0.35, 1e-12);
  EXPECT_EQ(estimate.active_bounds, std::vector<std::string>{"nu_min"});
  EXPECT_TRUE(estimate.PoissonRatioStandardError().has_value());
  EXPECT_TRUE(estimate.YoungsModulusStandardError().has_value());
  EstimatorOptions known;
  known.known_poisson_ratio = 0.35;
  EXPECT_NEAR(estimate.elasticity.youngs_modulus /
                  Run(scene, known).elasticity.youngs_modulus,
              1, 1e-6);

  EstimatorOptions soft;
  soft.youngs_modulus.upper = 4.8e4;
  const Estimate softer = Run(scene, soft);
  EXPECT_NEAR(softer.elasticity.youngs_modulus / 4.8e4, 1, 1e-12);
  EXPECT_EQ(softer.active_bounds, std::vector<std::string>{"youngs_max"});
  EXPECT_TRUE(softer.YoungsModulusStandardError().has_value());
  EXPECT_TRUE(softer.PoissonRatioStandardError().has_value());
}

TEST_P(DisplacementEstimators, SayThatTheDataContradictABound) {
  Scene scene = SmallScene("organ");
  Measure({5e4, 0.3}, scene);
  AddNoise(1e-3, 1, scene);
  for (const Bounds& bounds : {Bounds{{}, 4e4}, Bounds{6e4, {}}}) {
    for (const std::optional<double> nu :
         {std::optional<double>(), std::optional<double>(0.3)}) {
      EstimatorOptions options;
      options.youngs_modulus = bounds;
      options.known_poisson_ratio = nu;
      const Estimate estimate = Run(scene, options);
      EXPECT_EQ(estimate.status, Status::kNotIdentifiable);
      EXPECT_TRUE(estimate.IsRefusedFor(FindingCode::kParametersOnBounds))
          << estimate.message;
    }
  }
}

// The truth is within narrow bounds, and E what the nu in them leave open.
TEST_P(DisplacementEstimators, ErrorsOfEAllowForTheRoomOfNu) {
  int num_on_bound = 0;
  for (int seed = 1; seed <= 10; ++seed) {
    Scene scene = SmallScene("cuboid");
    Measure({5e4, 0.3}, scene);
    AddNoise(5e-2, seed, scene);
    EstimatorOptions options;
    options.poisson_ratio = {0.299, 0.301};
    const Estimate estimate = Run(scene, options);
    if (estimate.IsUsable() && !estimate.active_bounds.empty()) {
      ++num_on_bound;
      EXPECT_LT(std::abs(estimate.elasticity.youngs_modulus - 5e4),
                3.5 * *estimate.YoungsModulusStandardError())
          << seed;
    }
  }
  std::cout << "seeds 1 to 10: " << num_on_bound << " on a bound and usable\n";
  EXPECT_GT(num_on_bound, 2);
}

// Where the data determine the shear modulus alone, bounds on E leave nu no
// more room than they leave E.
TEST_P(DisplacementEstimators, ANarrowEDeterminesACollinearNu) {
  for (int seed = 1; seed <= 5; ++seed) {
    SCOPED_TRACE(seed);
    Scene scene = testing::ShearedBlock();
    AddNoise(1e-3, seed, scene);
    EXPECT_FALSE(Run(scene, {}).DeterminesAll());
    EstimatorOptions options;
    options.youngs_modulus = {4.95e4, 5.05e4};
    const Estimate estimate = Run(scene, options);
    ASSERT_EQ(estimate.status, Status::kOk) << estimate.message;
    const double standard_error = *estimate.PoissonRatioStandardError();
    EXPECT_LT(std::abs(estimate.elasticity.poisson_ratio - 0.3),
              2 * standard_error);
    EXPECT_GT(standard_error, 0.9 * 1.3 * 0.02 / std::sqrt(12.0));
    EXPECT_LT(standard_error, 1.1 * 1.3 * 0.02 / std::sqrt(3.0));
  }
}

// The truth is within narrow bounds, and nu what the E in them leave open.
TEST_P(DisplacementEstimators, ErrorsOfNuAllowForTheRoomOfE) {
  int num_on_bound = 0;
  for (int seed = 1; seed <= 10; ++seed) {
    Scene scene = SmallScene("cuboid");
    Measure({5e4, 0.3}, scene);
    AddNoise(2e-2, seed, scene);
    EstimatorOptions options;
    options.youngs_modulus = {4.9975e4, 5.0025e4};
    const Estimate estimate = Run(scene, options);
    if (estimate.IsUsable() && !estimate.active_bounds.empty()) {
      ++num_on_bound;
      EXPECT_LT(std::abs(estimate.elasticity.poisson_ratio - 0.3),
                3 * *estimate.PoissonRatioStandardError())
          << seed;
    }
  }
  std::cout << "seeds 1 to 10: " << num_on_bound << " on a bound and usable\n";
  EXPECT_GT(num_on_bound, 5);
}

class DisplacementEstimatorsStatistics : public DisplacementEstimators {};

TEST_P(DisplacementEstimatorsStatistics, LossesRejectOutliers) {
  constexpr int kSeeds = 30;
  Scene exact = SmallScene("organ");
  Measure({5e4, 0.3}, exact);
  const Eigen::Index num_nodes = exact.mesh.NumNodes();
  double clean = 0;
  double contaminated = 0;
  double robust[2] = {0, 0};
  const auto squared_error = [this](const Scene& scene, Loss loss) {
    EstimatorOptions options;
    options.loss = loss;
    const Estimate estimate = Run(scene, options);
    EXPECT_EQ(estimate.status, Status::kOk) << estimate.message;
    return std::pow(estimate.elasticity.youngs_modulus / 5e4 - 1, 2);
  };
  for (int seed = 1; seed <= kSeeds; ++seed) {
    Scene scene = exact;
    const double sd = AddNoise(0.01, seed, scene);
    clean += squared_error(scene, Loss::kNone);
    std::mt19937_64 generator(1000 + seed);
    for (int i = 0; i < 4; ++i) {  // 4 of 80 nodes, by 50 sigma.
      const Eigen::Index node = std::uniform_int_distribution<Eigen::Index>(
          16, num_nodes - 1)(generator);
      scene.load_cases[0].displacement.col(node).array() += 50 * sd;
    }
    contaminated += squared_error(scene, Loss::kNone);
    robust[0] += squared_error(scene, Loss::kHuber);
    robust[1] += squared_error(scene, Loss::kCauchy);
  }
  // Ratios of chi^2 sums of 30 have a relative sd of about 0.36.
  // Without a loss, points so far off are left out.
  EXPECT_LT(contaminated, 2 * clean);
  EXPECT_LT(robust[0], 2 * clean);
  EXPECT_LT(robust[1], 2 * clean);
}

TEST_P(DisplacementEstimators, LossesStandManyGrossOutliers) {
  Scene scene = SmallScene("organ");
  Measure({5e4, 0.3}, scene);
  const double sd = AddNoise(0.01, 1, scene);
  std::mt19937_64 generator(2);
  std::normal_distribution<double> normal(0, 1e4 * sd);
  for (Eigen::Index node = 0; node < scene.mesh.NumNodes(); node += 3) {
    scene.load_cases[0].displacement.col(node) += Eigen::Vector3d(
        normal(generator), normal(generator), normal(generator));
  }
  for (const Loss loss : {Loss::kHuber, Loss::kCauchy}) {
    EstimatorOptions options;
    options.loss = loss;
    const Estimate estimate = Run(scene, options);
    ASSERT_EQ(estimate.status, Status::kOk) << estimate.message;
    EXPECT_NEAR(estimate.elasticity.youngs_modulus, 5e4,
                4 * *estimate.YoungsModulusStandardError());
    EXPECT_LT(*estimate.YoungsModulusStandardError(), 2e3);
  }
}

TEST_P(DisplacementEstimators, LossesCostLittleOnCleanAndExactData) {
  Scene scene = SmallScene("organ");
  Measure({5e4, 0.3}, scene);
  EstimatorOptions options;
  options.loss = Loss::kHuber;
  const Estimate exact = Run(scene, options);
  ASSERT_EQ(exact.status, Status::kOk) << exact.message;
  EXPECT_NEAR(exact.elasticity.youngs_modulus / 5e4, 1, 1e-6);
  AddNoise(0.01, 1, scene);
  const Estimate huber = Run(scene, options);
  const Estimate plain = Run(scene, {});
  EXPECT_NEAR(
      *huber.YoungsModulusStandardError() / *plain.YoungsModulusStandardError(),
      1.03, 0.15);
}

TEST_P(DisplacementEstimators, NeedsSupports) {
  Scene scene = SmallScene("cuboid");
  Measure({5e4, 0.3}, scene);
  scene.supports.held.setConstant(false);
  EXPECT_THROWS_WITH(Run(scene, {}), "without strain.*closed-form");
}

INSTANTIATE_TEST_SUITE_P(Estimators, DisplacementEstimators,
                         ::testing::Values("iterative-fe", "reduced-fe"));
INSTANTIATE_TEST_SUITE_P(Estimators, DisplacementEstimatorsStatistics,
                         ::testing::Values("iterative-fe", "reduced-fe"));

}  // namespace
}  // namespace elastimate
