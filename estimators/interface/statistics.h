#ifndef ELASTIMATE_ESTIMATORS_INTERFACE_STATISTICS_H_
#define ELASTIMATE_ESTIMATORS_INTERFACE_STATISTICS_H_

#include <Eigen/Core>
#include <vector>

namespace elastimate {

/// The median; the mean of the middle two of an even number of values.
/// Precondition: not empty.  O(n).
double Median(std::vector<double> values);

/// The minimiser t of the sum of |y_i - t x_i|: the median of y_i / x_i with
/// weights |x_i|.  Precondition: some x_i is not zero.  O(n log n).
double LeastAbsoluteDeviations(const Eigen::VectorXd& x,
                               const Eigen::VectorXd& y);

}  // namespace elastimate

#endif  // ELASTIMATE_ESTIMATORS_INTERFACE_STATISTICS_H_
