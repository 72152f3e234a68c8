#include "elastimate/estimators/interface/statistics.h"

#include <algorithm>
#include <boost/math/distributions/chi_squared.hpp>
#include <boost/math/distributions/poisson.hpp>
#include <boost/math/distributions/students_t.hpp>
#include <cmath>
#include <utility>

#include "elastimate/estimators/interface/limits.h"

namespace elastimate {

double TwoSidedErrors(const std::optional<double>& degrees_of_freedom) {
  return degrees_of_freedom
             ? boost::math::quantile(
                   boost::math::students_t(*degrees_of_freedom), 0.975)
             : kTwoSidedErrors;
}

double OneSidedErrors(const std::optional<double>& degrees_of_freedom) {
  return degrees_of_freedom
             ? boost::math::quantile(
                   boost::math::students_t(*degrees_of_freedom), 0.95)
             : kOneSidedErrors;
}

double StudentTwoSidedProbability(double degrees_of_freedom, double t) {
  return 2 * boost::math::cdf(boost::math::complement(
                 boost::math::students_t(degrees_of_freedom), std::abs(t)));
}

double ChiSquaredProbability(double degrees_of_freedom, double value) {
  return boost::math::cdf(boost::math::complement(
      boost::math::chi_squared(degrees_of_freedom), value));
}

double ChiSquaredQuantile(double degrees_of_freedom, double probability_above) {
  return boost::math::quantile(boost::math::complement(
      boost::math::chi_squared(degrees_of_freedom), probability_above));
}

double PoissonProbability(double expected, double count) {
  return boost::math::cdf(
      boost::math::complement(boost::math::poisson(expected), count - 1));
}

double LeastAbsoluteDeviations(const Eigen::VectorXd& x,
                               const Eigen::VectorXd& y) {
  std::vector<std::pair<double, double>> ratios;  // y / x and its weight.
  double all_weights = 0;
  for (Eigen::Index i = 0; i < x.size(); ++i) {
    if (x(i) != 0) {
      ratios.emplace_back(y(i) / x(i), std::abs(x(i)));
      all_weights += std::abs(x(i));
    }
  }
  std::sort(ratios.begin(), ratios.end());
  double weights = 0;
  std::size_t middle = 0;
  while (middle + 1 < ratios.size() &&
         (weights += ratios[middle].second) < all_weights / 2) {
    ++middle;
  }
  return ratios[middle].first;
}

}  // namespace elastimate
