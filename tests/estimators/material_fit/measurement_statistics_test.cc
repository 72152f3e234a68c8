// Many measurements of one specimen whose end moved as measured: what is said
// of the errors is true on average.

#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "elastimate/core/equilibrium/simulated_measurement.h"
#include "elastimate/estimators/registry.h"
#include "tests/element_kinds.h"

namespace elastimate {
namespace {

constexpr int kMeasurements = 60;
const IsotropicElasticity kSteel = {2.1e5, 0.3};

// A strip of 20 x 10 quadrilaterals that is pulled to one side.
Scene Strip() {
  constexpr int kColumns = 20;
  constexpr int kRows = 10;
  Scene scene;
  scene.mesh.kind = ElementKind::kQuad4;
  scene.mesh.section = {SectionModel::kPlaneStress, 2};
  scene.mesh.nodes.resize(2, (kColumns + 1) * (kRows + 1));
  scene.mesh.elements.resize(4, kColumns * kRows);
  const auto node = [&](int i, int j) { return i * (kRows + 1) + j; };
  for (int i = 0; i <= kColumns; ++i) {
    for (int j = 0; j <= kRows; ++j) {
      scene.mesh.nodes.col(node(i, j)) << i, j;
      if (i < kColumns && j < kRows) {
        scene.mesh.elements.col(i * kRows + j) << node(i, j), node(i + 1, j),
            node(i + 1, j + 1), node(i, j + 1);
      }
    }
  }
  const Eigen::Index n = scene.mesh.NumNodes();
  scene.supports.held = ComponentMask::Constant(2, n, false);
  scene.supports.held.leftCols(kRows + 1).setConstant(true);
  scene.supports.displacement.setZero(2, n);
  NodalForces forces{Eigen::MatrixXd::Zero(2, n)};
  forces.force.rightCols(kRows + 1).row(0).setConstant(1000);
  forces.force.rightCols(kRows + 1).row(1).setConstant(100);
  scene.load_cases.resize(1);
  scene.load_cases[0].loads = {forces};
  Measure(kSteel, scene);
  scene.supports.unknown = scene.supports.held;
  return scene;
}

double ScaleOf(const Scene& scene) {
  const Eigen::MatrixXd& u = scene.load_cases[0].displacement;
  return u.norm() / std::sqrt(double(u.size()));
}

// Independent noise, or the mean of that of `reach` neighbours on each side.
Eigen::MatrixXd Noise(const Scene& scene, double noise_sd, int reach,
                      unsigned seed) {
  constexpr int kPoints = 11;
  std::mt19937_64 generator(seed);
  std::normal_distribution<double> normal(0, noise_sd);
  const int num_columns = int(scene.mesh.NumNodes()) / kPoints;
  Eigen::MatrixXd noise(2, scene.mesh.NumNodes());
  for (int component = 0; component < 2; ++component) {
    Eigen::MatrixXd white(kPoints + 2 * reach, num_columns + 2 * reach);
    for (double& value : white.reshaped()) {
      value = normal(generator);
    }
    for (int i = 0; i < num_columns; ++i) {
      for (int j = 0; j < kPoints; ++j) {
        noise(component, i * kPoints + j) =
            white.block(j, i, 2 * reach + 1, 2 * reach + 1).sum() /
            (2 * reach + 1);
      }
    }
  }
  return noise;
}

struct Trials {
  Eigen::Vector2d mean_square_score = Eigen::Vector2d::Zero();
  Eigen::Vector2d coverage = Eigen::Vector2d::Zero();
  Eigen::Vector2d mean_standard_error = Eigen::Vector2d::Zero();
};

Trials RunTrials(double relative_noise, int reach) {
  const Scene exact = Strip();
  const double noise_sd = relative_noise * ScaleOf(exact);
  Trials trials;
  for (int seed = 0; seed < kMeasurements; ++seed) {
    Scene scene = exact;
    scene.load_cases[0].displacement +=
        Noise(scene, noise_sd, reach, unsigned(seed));
    const Estimate estimate = MakeEstimator("iterative-fe")->Run(scene, {});
    EXPECT_EQ(estimate.status, Status::kOk) << estimate.message;
    const Eigen::Vector2d error(
        estimate.elasticity.youngs_modulus - kSteel.youngs_modulus,
        estimate.elasticity.poisson_ratio - kSteel.poisson_ratio);
    const Eigen::Vector2d standard_error(
        estimate.YoungsModulusStandardError().value_or(0),
        estimate.PoissonRatioStandardError().value_or(0));
    const Eigen::Array2d score = error.array() / standard_error.array();
    trials.mean_square_score += score.square().matrix() / kMeasurements;
    trials.coverage +=
        (score.abs() < 1.96).cast<double>().matrix() / double(kMeasurements);
    trials.mean_standard_error += standard_error / kMeasurements;
  }
  return trials;
}

TEST(MeasuredSupportStatistics, ErrorsAreTrueOfIndependentNoise) {
  const Trials trials = RunTrials(0.02, 0);
  for (int i = 0; i < 2; ++i) {
    // chi^2 / n of n = 60 has the standard deviation .18.
    EXPECT_NEAR(trials.mean_square_score(i), 1, 4 * 0.18);
    // A share of .95 of 60 has a standard deviation of .028.
    EXPECT_GE(trials.coverage(i), 0.95 - 4 * 0.028);
  }
}

TEST(MeasuredSupportStatistics, ErrorsAreTrueOfCorrelatedNoise) {
  const Trials trials = RunTrials(0.02, 1);
  for (int i = 0; i < 2; ++i) {
    // Noise of neighbours 2/3 alike and of nine times the weight: errors of
    // independent noise would be about a third of these, and cover half.
    EXPECT_LE(trials.mean_square_score(i), 1.6);
    EXPECT_GE(trials.coverage(i), 0.85);
  }
}

// What the look for correlation costs where there is none.
TEST(MeasuredSupportStatistics, IndependentNoiseKeepsItsErrors) {
  const Scene exact = Strip();
  const double noise_sd = 0.02 * ScaleOf(exact);
  double ratio = 0;
  for (int seed = 0; seed < kMeasurements; ++seed) {
    Scene scene = exact;
    scene.load_cases[0].displacement +=
        Noise(scene, noise_sd, 0, unsigned(seed));
    const Estimate estimate = MakeEstimator("iterative-fe")->Run(scene, {});
    ratio += *estimate.YoungsModulusStandardError() /
             (kSteel.youngs_modulus * estimate.error_budget.noise(0)) /
             kMeasurements;
  }
  EXPECT_LE(ratio, 1.05);
}

}  // namespace
}  // namespace elastimate
