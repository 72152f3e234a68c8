// Monte Carlo: errors under noise that is alike at neighbouring nodes, as of
// image correlation.

#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "elastimate/core/equilibrium/simulated_measurement.h"
#include "elastimate/estimators/displacement_fit/reduced_fe.h"
#include "tests/scenes.h"

namespace elastimate {
namespace {

using testing::Measure;

constexpr IsotropicElasticity kSoftBlock = {5e4, 0.3};
constexpr int kCorrelatedMeasurements = 60;
constexpr double kSpacing = 0.05;

struct CorrelatedTrials {
  int num_usable = 0;
  Eigen::Array2d mean_square_score = Eigen::Array2d::Zero();
  Eigen::Array2d coverage = Eigen::Array2d::Zero();
  /// Mean stated error over the root mean square of errors.
  Eigen::Array2d sharpness = Eigen::Array2d::Zero();
};

// 1 % of the root mean square displacement, alike over this length.
CorrelatedTrials RunCorrelatedTrials(double correlation_length) {
  const Mesh mesh = testing::BoxMesh({8, 8, 16}, {0.4, 0.4, 0.8});
  Scene exact = testing::HeldAtBottom(mesh, mesh, {0.3, 0, -1});
  Measure(kSoftBlock, exact);
  const Eigen::MatrixXd& displacement = exact.load_cases[0].displacement;
  const double deviation =
      0.01 * displacement.norm() / std::sqrt(double(displacement.size()));
  const ReducedFe reduced_fe;
  PreparedEstimator prepared = reduced_fe.Prepare(exact, {});
  CorrelatedTrials trials;
  Eigen::Array2d square_sum = Eigen::Array2d::Zero();
  Eigen::Array2d standard_errors = Eigen::Array2d::Zero();
  for (int seed = 1; seed <= kCorrelatedMeasurements; ++seed) {
    std::mt19937_64 generator{std::uint64_t(seed)};
    const Eigen::MatrixXd noise =
        DrawNoiseAt(mesh.nodes, deviation, correlation_length, generator);
    const Estimate estimate =
        prepared.Run({displacement + exact.supports.held.select(0, noise)});
    if (!estimate.IsUsable()) {
      continue;
    }
    ++trials.num_usable;
    const Eigen::Array2d error(
        estimate.elasticity.youngs_modulus - kSoftBlock.youngs_modulus,
        estimate.elasticity.poisson_ratio - kSoftBlock.poisson_ratio);
    const Eigen::Array2d standard_error(*estimate.YoungsModulusStandardError(),
                                        *estimate.PoissonRatioStandardError());
    trials.mean_square_score += (error / standard_error).square();
    trials.coverage += (error.abs() < 1.96 * standard_error).cast<double>();
    square_sum += error.square();
    standard_errors += standard_error;
  }
  const double n = trials.num_usable;
  trials.mean_square_score /= n;
  trials.coverage /= n;
  trials.sharpness = standard_errors / n / (square_sum / n).sqrt();
  return trials;
}

// Noise that is alike over one spacing of the nodes, a sixteenth of the block,
// may be a fault of the model, and counts as one in part.
TEST(CorrelatedMeasurementStatistics, ErrorsHoldAndAreNotMuchLarger) {
  const CorrelatedTrials trials = RunCorrelatedTrials(kSpacing);
  EXPECT_EQ(trials.num_usable, kCorrelatedMeasurements);
  for (int i = 0; i < 2; ++i) {
    EXPECT_GE(trials.coverage(i), 0.95 - 4 * 0.0281);
    EXPECT_LE(trials.sharpness(i), 6);
  }
}

// Whether noise so smooth is noise, one measurement does not tell.
TEST(CorrelatedMeasurementStatistics, NoiseOverAQuarterIsAFaultOfTheModel) {
  const CorrelatedTrials trials = RunCorrelatedTrials(4 * kSpacing);
  EXPECT_LE(trials.num_usable, kCorrelatedMeasurements / 4);
}

}  // namespace
}  // namespace elastimate
