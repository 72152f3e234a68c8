#include "elastimate/estimators/statistics/scalar_search.h"

#include <boost/math/tools/toms748_solve.hpp>
#include <cmath>
#include <cstdint>
#include <utility>

#include "elastimate/core/laws/elasticity.h"

namespace elastimate {

Eigen::VectorXd EvenPoissonRatios(double lower, double upper,
                                  Eigen::Index count) {
  Eigen::VectorXd values =
      Eigen::VectorXd::LinSpaced(count, LogStiffnessRatio(lower),
                                 LogStiffnessRatio(upper))
          .unaryExpr(&PoissonRatioOfLogStiffnessRatio);
  values(0) = lower;
  values(count - 1) = upper;
  return values;
}

double ZeroBetween(const std::function<double(double)>& f, double a, double f_a,
                   double b, double f_b, double tolerance) {
  // False where a value is not a number: Boost throws at what encloses nothing.
  const auto encloses_zero = [&] {
    return (f_a < 0 && f_b > 0) || (f_a > 0 && f_b < 0);
  };
  std::uintmax_t evaluations_left = 60;
  while (!encloses_zero()) {
    if (f_a == 0) {
      return a;
    }
    if (f_b == 0 || evaluations_left == 0 || !(std::abs(b - a) > tolerance)) {
      return b;
    }
    const double middle = a + (b - a) / 2;
    const double f_middle = f(middle);
    --evaluations_left;
    const bool is_like_a = (f_middle > 0) == (f_a > 0);
    (is_like_a ? a : b) = middle;
    (is_like_a ? f_a : f_b) = f_middle;
  }
  if (a > b) {
    std::swap(a, b);
    std::swap(f_a, f_b);
  }
  const auto [left, right] = boost::math::tools::toms748_solve(
      std::cref(f), a, b, f_a, f_b,
      [tolerance](double from, double to) { return to - from <= tolerance; },
      evaluations_left);
  return left + (right - left) / 2;
}

}  // namespace elastimate
