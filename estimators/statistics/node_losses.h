#ifndef ELASTIMATE_ESTIMATORS_STATISTICS_NODE_LOSSES_H_
#define ELASTIMATE_ESTIMATORS_STATISTICS_NODE_LOSSES_H_

#include <Eigen/Core>
#include <array>

#include "elastimate/estimators/interface/estimator.h"

namespace elastimate {

/// rho(s) of a loss and its first two derivatives at the square sum s of the
/// residuals of a node of `count` components, so that a bad node counts less as
/// a whole: Huber's (k = 1.345) or Cauchy's (c = 2.385) for residuals of this
/// standard deviation per component.  The norm of n of them is sqrt(n) standard
/// deviations in the mean.
std::array<double, 3> EvaluateLoss(Loss loss, double residual_sd, int count,
                                   double square_sum);

/// 1.4826 MAD of the residuals, which is their standard deviation when they
/// are Gaussian, and is not moved by up to half of them.  Precondition: not
/// empty.
double RobustStandardDeviation(const Eigen::VectorXd& residual);

}  // namespace elastimate

#endif  // ELASTIMATE_ESTIMATORS_STATISTICS_NODE_LOSSES_H_
