#ifndef ELASTIMATE_ESTIMATORS_FORCE_BALANCE_FORCE_REGRESSION_H_
#define ELASTIMATE_ESTIMATORS_FORCE_BALANCE_FORCE_REGRESSION_H_

#include "elastimate/core/scene/scene.h"
#include "elastimate/estimators/interface/estimate.h"
#include "elastimate/estimators/interface/estimator.h"

namespace elastimate {

/// The parameters of any materials by regression of the loads on the columns of
/// the internal forces of the measured displacements, over the free degrees of
/// freedom of all load cases,
///
///   min ||F theta - f||^2,   F = [f_1(q) ... f_m(q)].
///
/// Unlike the paper's residual of one isotropic material, whose coefficient of
/// H q is 1, the loads are the response.  With bounds, or known parameters, the
/// minimum is sought by Ceres over the parameters, in the triangle of the QR
/// factorisation of [F f].
///
/// Noise of variance sigma^2 in q biases theta by -(F^T F - sigma^2 T)^-1
/// sigma^2 T theta to first order, T_kl = tr(K_k K_l), and gives it the
/// covariance sigma^2 N^-1 F^T K K F N^-1, N = F^T F.  sigma^2 is as given, or
/// from the residual: ||r||^2 = sigma^2 theta^T T theta in the mean.
///
/// Preconditions are those of Estimator::Run; every free component is observed.
/// Cost: two element passes and one of m columns for each load case, and two
/// passes for T.
Estimate RegressForces(const Scene& scene, const EstimatorOptions& options,
                       bool is_bounded);

}  // namespace elastimate

#endif  // ELASTIMATE_ESTIMATORS_FORCE_BALANCE_FORCE_REGRESSION_H_
