// Monte Carlo tests compare errors with the Cramer-Rao bound, and count how
// often intervals hold the truth, under more noise than the conformance tests
// have.

#include <gtest/gtest.h>

#include <cmath>
#include <cstdio>
#include <iostream>
#include <string>
#include <tuple>

#include "elastimate/estimators/force_balance/virtual_fields.h"
#include "elastimate/estimators/material_fit/reduced_fe.h"
#include "elastimate/estimators/plan/expected_information.h"
#include "tests/scenes.h"

namespace elastimate {
namespace {

using testing::AddNoise;
using testing::Measure;
using testing::SmallScene;

// The seeds are 1, 2, ...  A root mean square of this many errors has a
// standard deviation of 5 %.  The study `unseen` counts thousands of trials.
constexpr int kSeeds = 200;

class CoverageStatistics
    : public ::testing::TestWithParam<std::tuple<std::string, double, double>> {
};

TEST_P(CoverageStatistics, OfReducedFeIsThatOfItsIntervals) {
  const auto& [shape, nu, noise] = GetParam();
  const IsotropicElasticity truth = {5e4, nu};
  Scene exact = SmallScene(shape);
  Measure(truth, exact);
  Scene noisy = exact;
  const double sd = AddNoise(noise, 1, noisy);
  const Eigen::Matrix2d bound = CramerRaoBound(
      exact, truth.Parameters(), Eigen::VectorXd::Constant(1, sd));
  const ReducedFe reduced_fe;
  PreparedEstimator prepared = reduced_fe.Prepare(exact, {});
  int num_usable = 0;
  int num_youngs = 0;
  int num_poisson = 0;
  double youngs_square_sum = 0;
  double poisson_square_sum = 0;
  for (int seed = 1; seed <= kSeeds; ++seed) {
    noisy.load_cases[0].displacement = exact.load_cases[0].displacement;
    AddNoise(noise, std::uint64_t(seed), noisy);
    const Estimate estimate = prepared.Run({noisy.load_cases[0].displacement});
    if (!estimate.IsUsable()) {
      continue;
    }
    ++num_usable;
    const double youngs_error =
        estimate.elasticity.youngs_modulus - truth.youngs_modulus;
    youngs_square_sum += youngs_error * youngs_error;
    poisson_square_sum += std::pow(estimate.elasticity.poisson_ratio - nu, 2);
    num_youngs +=
        std::abs(youngs_error) < 1.96 * *estimate.YoungsModulusStandardError();
    const Interval interval = estimate.poisson_ratio_interval.value();
    num_poisson += interval.lower <= nu && nu <= interval.upper;
  }
  const double n = num_usable;
  const double youngs = std::sqrt(youngs_square_sum / n / bound(0, 0));
  const double poisson = std::sqrt(poisson_square_sum / n / bound(1, 1));
  std::printf(
      "%s, nu %g, noise %g: %d of %d usable, error over Cramer-Rao %.3f (E), "
      "%.3f (nu), coverage %.4f (E), %.4f (nu), Cramer-Rao sd of nu %.3g\n",
      shape.c_str(), nu, noise, num_usable, kSeeds, youngs, poisson,
      num_youngs / n, num_poisson / n, std::sqrt(bound(1, 1)));
  // A few measurements may be refused: where nu is more than three standard
  // errors off, a specimen of another nu may explain them as well.
  EXPECT_GE(num_usable, kSeeds - 4);
  EXPECT_NEAR(youngs, 1, 4 * 0.05);
  EXPECT_NEAR(poisson, 1, 4 * 0.05);
  const double four_deviations = 4 * std::sqrt(0.95 * 0.05 / kSeeds);
  EXPECT_NEAR(num_youngs / n, 0.95, four_deviations);
  EXPECT_NEAR(num_poisson / n, 0.95, four_deviations);
}

INSTANTIATE_TEST_SUITE_P(Scenes, CoverageStatistics,
                         ::testing::Combine(::testing::Values("cuboid",
                                                              "organ"),
                                            ::testing::Values(0.0, 0.3, 0.49),
                                            ::testing::Values(1e-3, 1e-1)));

struct CoverageCase {
  int degree;
  std::string shape;
  double noise;
  // Student's t has this probability within 1.96 standard errors.  The noise is
  // estimated from few equations, so the degrees of freedom are 12, 30 or 60
  // less the two unknowns.
  double coverage;
};

std::ostream& operator<<(std::ostream& out, const CoverageCase& parameters) {
  return out << "degree " << parameters.degree << ", " << parameters.shape
             << ", noise " << parameters.noise;
}

class VirtualFieldsCoverageStatistics
    : public ::testing::TestWithParam<CoverageCase> {};

TEST_P(VirtualFieldsCoverageStatistics, IsThatOfItsStandardErrors) {
  constexpr int kFewerSeeds = 400;
  const IsotropicElasticity truth = {5e4, 0.3};
  Scene exact = SmallScene(GetParam().shape);
  Measure(truth, exact);
  Scene noisy = exact;
  const double sd = AddNoise(GetParam().noise, 1, noisy);
  const Eigen::Matrix2d bound = CramerRaoBound(
      exact, truth.Parameters(), Eigen::VectorXd::Constant(1, sd));
  EstimatorOptions options;
  options.virtual_field_degree = GetParam().degree;
  Eigen::Array2d sum = Eigen::Array2d::Zero();
  Eigen::Array2d square_sum = Eigen::Array2d::Zero();
  Eigen::Array2d num_covering = Eigen::Array2d::Zero();
  Eigen::Array2d standard_error_sum = Eigen::Array2d::Zero();
  const VirtualFields virtual_fields;
  PreparedEstimator prepared = virtual_fields.Prepare(exact, options);
  int num_usable = 0;
  for (int seed = 1; seed <= kFewerSeeds; ++seed) {
    noisy.load_cases[0].displacement = exact.load_cases[0].displacement;
    AddNoise(GetParam().noise, std::uint64_t(seed), noisy);
    const Estimate estimate = prepared.Run({noisy.load_cases[0].displacement});
    EXPECT_TRUE(estimate.IsUsable())
        << "seed " << seed << ", nu = " << estimate.elasticity.poisson_ratio
        << ": " << estimate.message;
    if (!estimate.IsUsable()) {
      continue;
    }
    ++num_usable;
    const Eigen::Array2d error(
        estimate.elasticity.youngs_modulus - truth.youngs_modulus,
        estimate.elasticity.poisson_ratio - truth.poisson_ratio);
    const Eigen::Array2d standard_error(*estimate.YoungsModulusStandardError(),
                                        *estimate.PoissonRatioStandardError());
    sum += error;
    square_sum += error.square();
    standard_error_sum += standard_error;
    num_covering += (error.abs() < 1.96 * standard_error).cast<double>();
  }
  const double n = num_usable;
  const Eigen::Array2d rms = (square_sum / n).sqrt();
  const Eigen::Array2d bias = (sum / n).abs() / rms * std::sqrt(n);
  const Eigen::Array2d over_bound = rms / bound.diagonal().array().sqrt();
  const Eigen::Array2d coverage = num_covering / n;
  std::cout << GetParam() << ": " << num_usable << " of " << kFewerSeeds
            << " usable, error over Cramer-Rao " << over_bound.transpose()
            << ", over the standard error "
            << (rms * n / standard_error_sum).transpose()
            << ", bias in standard deviations of the mean " << bias.transpose()
            << ", coverage " << coverage.transpose() << " (E, nu)\n";
  EXPECT_LT(bias.maxCoeff(), 4);
  // The tolerances are three standard deviations of a root mean square, and of
  // a frequency.
  EXPECT_GT(over_bound.minCoeff(), 1 - 3 / std::sqrt(2.0 * kFewerSeeds));
  const double expected = GetParam().coverage;
  EXPECT_GT(coverage.minCoeff(),
            expected - 3 * std::sqrt(expected * (1 - expected) / kFewerSeeds));
}

INSTANTIATE_TEST_SUITE_P(
    Scenes, VirtualFieldsCoverageStatistics,
    ::testing::Values(CoverageCase{1, "cuboid", 1e-2, 0.9216},
                      CoverageCase{2, "cuboid", 1e-2, 0.9401},
                      CoverageCase{2, "cuboid", 1e-1, 0.9401},
                      CoverageCase{3, "cuboid", 1e-1, 0.9451},
                      CoverageCase{1, "organ", 1e-2, 0.9216},
                      CoverageCase{2, "organ", 1e-2, 0.9401},
                      CoverageCase{2, "organ", 1e-1, 0.9401},
                      CoverageCase{3, "organ", 1e-1, 0.9451}));

}  // namespace
}  // namespace elastimate
