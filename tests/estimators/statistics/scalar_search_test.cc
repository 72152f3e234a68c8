#include "elastimate/estimators/statistics/scalar_search.h"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <limits>
#include <utility>

namespace elastimate {
namespace {

constexpr double kTolerance = 1e-13;

struct Found {
  double zero;
  int num_evaluations;  // Those of the ends among them.
};

Found Find(const std::function<double(double)>& f, double a, double b) {
  Found found = {0, 0};
  const auto counted = [&](double x) {
    ++found.num_evaluations;
    return f(x);
  };
  const double f_a = counted(a);
  const double f_b = counted(b);
  found.zero = ZeroBetween(counted, a, f_a, b, f_b, kTolerance);
  return found;
}

// By nothing but halves, of a function that is negative at `lower` alone.
Found Bisect(const std::function<double(double)>& f, double lower,
             double upper) {
  Found found = {0, 2};
  while (upper - lower > kTolerance) {
    const double middle = (lower + upper) / 2;
    ++found.num_evaluations;
    (f(middle) < 0 ? lower : upper) = middle;
  }
  found.zero = (lower + upper) / 2;
  return found;
}

TEST(EvenPoissonRatios, MultiplyTheStiffnessRatioByTheSameFactor) {
  for (const auto& [lower, upper] :
       {std::pair(-0.9999, 0.49999), std::pair(0.1, 0.2)}) {
    const Eigen::VectorXd values = EvenPoissonRatios(lower, upper, 64);
    ASSERT_EQ(values.size(), 64);
    EXPECT_EQ(values(0), lower);
    EXPECT_EQ(values(63), upper);
    const Eigen::ArrayXd ratios =
        (1 + values.array()) / (1 - 2 * values.array());
    const double factor = std::pow(ratios(63) / ratios(0), 1.0 / 63);
    for (Eigen::Index i = 1; i < values.size(); ++i) {
      EXPECT_NEAR(ratios(i) / ratios(i - 1) / factor, 1, 1e-10);
    }
  }
}

TEST(ZeroBetween, FindsWhatHalvesFindInAThirdOfTheEvaluations) {
  const std::function<double(double)> smooth[] = {
      [](double x) { return x - 0.3; },
      [](double x) { return std::exp(x) - 1.2; },
      [](double x) { return x * x * x - 0.4; },
      [](double x) { return std::atan(20 * (x - 0.7)); },
      [](double x) { return 1 / (1.5 - x) - 1.2; },
      [](double x) { return x - std::cos(x); }};
  for (const auto& f : smooth) {
    const Found halves = Bisect(f, 0, 1);
    const Found found = Find(f, 0, 1);
    const Found backwards = Find(f, 1, 0);
    SCOPED_TRACE(halves.zero);
    EXPECT_NEAR(found.zero, halves.zero, 2 * kTolerance);
    EXPECT_NEAR(backwards.zero, halves.zero, 2 * kTolerance);
    EXPECT_LE(3 * found.num_evaluations, halves.num_evaluations);
    EXPECT_LE(3 * backwards.num_evaluations, halves.num_evaluations);
  }
}

TEST(ZeroBetween, FindsWhereFunctionsAreNotSmooth) {
  const std::function<double(double)> rough[] = {
      [](double x) { return x < 0.3 ? -1.0 : 1.0; },
      [](double x) { return x < 0.3 ? x - 0.3 : 1e6 * (x - 0.3); },
      [](double x) { return x < 0.3 ? -1e-25 : x - 0.3; },
      [](double x) { return std::cbrt(x - 0.3); }};
  for (const auto& f : rough) {
    const Found found = Find(f, -0.5, 1);
    EXPECT_NEAR(found.zero, 0.3, kTolerance);
    EXPECT_LE(found.num_evaluations, 62);
  }
}

TEST(ZeroBetween, TakesAnEndThatIsOne) {
  const auto f = [](double x) { return x * (1 - x); };
  EXPECT_EQ(Find(f, 0, 0.5).zero, 0);
  EXPECT_EQ(Find(f, 0.5, 1).zero, 1);
  EXPECT_EQ(Find(f, 1, 0.5).zero, 1);
  EXPECT_EQ(Find(f, 1, 1).zero, 1);
}

TEST(ZeroBetween, LooksByHalvesWhereTheEndsEncloseNone) {
  const auto f = [](double x) { return (x - 0.3) * (x - 0.6); };
  EXPECT_NEAR(Find(f, 0, 1).zero, 0.3, kTolerance);
  EXPECT_NEAR(Find(f, 1, 0).zero, 0.6, kTolerance);
  // Values of which the product is zero by underflow.
  EXPECT_NEAR(Find([&f](double x) { return 1e-200 * f(x); }, 0, 1).zero, 0.3,
              kTolerance);
}

TEST(ZeroBetween, EndsWhereThereIsNone) {
  const Found found = Find([](double x) { return 1 + x; }, 0, 1);
  EXPECT_NEAR(found.zero, 1, kTolerance);
  EXPECT_LE(found.num_evaluations, 62);
  const double nan = std::numeric_limits<double>::quiet_NaN();
  const Found unknown = Find([nan](double /*x*/) { return nan; }, 0, 1);
  EXPECT_TRUE(unknown.zero >= 0 && unknown.zero <= 1);
  EXPECT_LE(unknown.num_evaluations, 62);
}

}  // namespace
}  // namespace elastimate
