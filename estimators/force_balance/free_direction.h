#ifndef ELASTIMATE_ESTIMATORS_FORCE_BALANCE_FREE_DIRECTION_H_
#define ELASTIMATE_ESTIMATORS_FORCE_BALANCE_FREE_DIRECTION_H_

#include <Eigen/Core>

#include "elastimate/estimators/interface/estimate.h"
#include "elastimate/estimators/interface/evidence.h"
#include "elastimate/estimators/interface/free_parameters.h"

namespace elastimate {

/// The least singular value of the columns, each divided by its norm; 0 where
/// that is zero.
double LeastSingularValue(const Eigen::MatrixXd& columns);

/// Whether some direction of the variables leaves a residual as it is, by its
/// derivatives (num_residuals x num_variables): their
/// LeastSingularValue is not above `rounding`.  Enters it as
/// evidence. Precondition: the parameters of the estimate are entered.
bool NoteFreeDirection(const Eigen::MatrixXd& derivatives, double rounding,
                       const FreeParameters& free, const Estimate& estimate,
                       Evidence& evidence);

}  // namespace elastimate

#endif  // ELASTIMATE_ESTIMATORS_FORCE_BALANCE_FREE_DIRECTION_H_
