#ifndef ELASTIMATE_ESTIMATORS_STATISTICS_ERROR_PROPAGATION_H_
#define ELASTIMATE_ESTIMATORS_STATISTICS_ERROR_PROPAGATION_H_

#include <Eigen/Core>

#include "elastimate/estimators/interface/estimate.h"

namespace elastimate {

/// Makes the errors of an estimate those of P d, where d are errors of
/// (ln E, nu) as they are: the covariance C becomes P C P^T.  The parts of the
/// budget, of which no correlation is known, become the square sums of what
/// each parameter gives.
void PropagateErrors(const Eigen::Matrix2d& propagation, Estimate& estimate);

}  // namespace elastimate

#endif  // ELASTIMATE_ESTIMATORS_STATISTICS_ERROR_PROPAGATION_H_
