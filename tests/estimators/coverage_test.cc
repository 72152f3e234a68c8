// Monte Carlo: errors against the Cramer-Rao bound, and how often the intervals
// hold the truth.

#include <gtest/gtest.h>

#include <cmath>
#include <cstdio>
#include <string>
#include <tuple>

#include "elastimate/estimators/cramer_rao.h"
#include "elastimate/estimators/reduced_fe.h"
#include "tests/scenes.h"

namespace elastimate {
namespace {

using testing::AddNoise;
using testing::Measure;
using testing::SmallScene;

// Seeds 1, 2, ...; the frequency of an event of 95 % has a standard deviation
// of 0.5 % over these many, and a root mean square of errors one of 1.6 %.
constexpr int kSeeds = 2000;

class Coverage
    : public ::testing::TestWithParam<std::tuple<std::string, double, double>> {
};

TEST_P(Coverage, OfReducedFeIsThatOfItsIntervals) {
  const auto& [shape, nu, noise] = GetParam();
  const IsotropicElasticity truth = {5e4, nu};
  Scene exact = SmallScene(shape);
  Measure(truth, exact);
  Scene noisy = exact;
  const double sd = AddNoise(noise, 1, noisy);
  const Eigen::Matrix2d bound =
      CramerRaoBound(exact, truth, Eigen::VectorXd::Constant(1, sd));
  PreparedReducedFe prepared(exact, {});
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
  EXPECT_EQ(num_usable, kSeeds);
  EXPECT_LT(youngs, 1.1);
  EXPECT_LT(poisson, 1.1);
  EXPECT_GT(youngs, 0.9);
  EXPECT_GT(poisson, 0.9);
  EXPECT_NEAR(num_youngs / n, 0.95, 0.02);
  EXPECT_NEAR(num_poisson / n, 0.95, 0.02);
}

INSTANTIATE_TEST_SUITE_P(
    Scenes, Coverage,
    ::testing::Combine(::testing::Values("cuboid", "organ"),
                       ::testing::Values(0.0, 0.3, 0.45, 0.49),
                       ::testing::Values(1e-3, 1e-2, 1e-1)));

}  // namespace
}  // namespace elastimate
