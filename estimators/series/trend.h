#ifndef ELASTIMATE_ESTIMATORS_SERIES_TREND_H_
#define ELASTIMATE_ESTIMATORS_SERIES_TREND_H_

#include <Eigen/Core>
#include <optional>

#include "elastimate/estimators/interface/estimate.h"

namespace elastimate {

/// How values change with x, by a straight line of least squares through
/// values(i, :) of variances(i, :) at x(i), for each column by itself.  Its
/// errors are scaled by the scatter about the line where that is larger than
/// the variances say, and p-values are those of Student's t with n - 2 degrees
/// of freedom.  Empty below 4 values, and where all x are the same.
/// Precondition: positive variances.
std::optional<Trend> FindTrend(const Eigen::VectorXd& x,
                               const Eigen::MatrixXd& values,
                               const Eigen::MatrixXd& variances);

}  // namespace elastimate

#endif  // ELASTIMATE_ESTIMATORS_SERIES_TREND_H_
