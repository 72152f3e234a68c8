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

/// The median; the mean of the middle two of an even number of values.
/// Precondition: not empty.  O(n).
double Median(std::vector<double> values);

/// The minimiser t of the sum of |y_i - t x_i|: the median of y_i / x_i with
/// weights |x_i|.  Precondition: some x_i is not zero.  O(n log n).
double LeastAbsoluteDeviations(const Eigen::VectorXd& x,
                               const Eigen::VectorXd& y);

}  // namespace elastimate

#endif  // ELASTIMATE_ESTIMATORS_INTERFACE_STATISTICS_H_
