#ifndef ELASTIMATE_ESTIMATORS_INTERFACE_STATISTICS_H_
#define ELASTIMATE_ESTIMATORS_INTERFACE_STATISTICS_H_

#include <Eigen/Core>
#include <optional>
#include <vector>

namespace elastimate {

/// The distance from the middle, in standard errors, within which Student's t
/// of so many degrees of freedom lies with a probability of 95 %, on both sides
/// and on one; of the normal distribution where they are many: no number is
/// given.  Precondition: positive.
double TwoSidedErrors(const std::optional<double>& degrees_of_freedom);
double OneSidedErrors(const std::optional<double>& degrees_of_freedom);

// Boost's distributions are called here only: a compiler takes seconds for each
// source that names one.

/// The probability that |Student's t| exceeds |t|.
double StudentTwoSidedProbability(double degrees_of_freedom, double t);

/// The probability that chi^2 of so many degrees of freedom exceeds `value`,
/// and the value that it exceeds with this probability.  Preconditions:
/// positive degrees of freedom, `value` >= 0.
double ChiSquaredProbability(double degrees_of_freedom, double value);
double ChiSquaredQuantile(double degrees_of_freedom, double probability_above);

/// The probability of `count` and more of events of which so many are expected.
/// Preconditions: `expected` > 0, `count` >= 1.
double PoissonProbability(double expected, double count);

/// The minimiser t of the sum of |y_i - t x_i|: the median of y_i / x_i with
/// weights |x_i|.  Precondition: some x_i is not zero.  O(n log n).
double LeastAbsoluteDeviations(const Eigen::VectorXd& x,
                               const Eigen::VectorXd& y);

}  // namespace elastimate

#endif  // ELASTIMATE_ESTIMATORS_INTERFACE_STATISTICS_H_
