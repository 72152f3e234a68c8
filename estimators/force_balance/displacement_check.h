#ifndef ELASTIMATE_ESTIMATORS_FORCE_BALANCE_DISPLACEMENT_CHECK_H_
#define ELASTIMATE_ESTIMATORS_FORCE_BALANCE_DISPLACEMENT_CHECK_H_

#include <Eigen/Core>

#include "elastimate/core/scene/scene.h"
#include "elastimate/estimators/force_balance/virtual_work.h"
#include "elastimate/estimators/interface/estimate.h"
#include "elastimate/estimators/interface/estimator.h"
#include "elastimate/estimators/interface/evidence.h"
#include "elastimate/estimators/interface/free_parameters.h"

namespace elastimate {

/// Variables that balance the virtual work of a measurement, with the residual
/// z = L^-1 r of WorkBalance there and its derivative J.
struct BalanceFit {
  Eigen::VectorXd variables;
  Eigen::VectorXd residual;
  Eigen::MatrixXd jacobian;

  /// Equations that are not fitted; at least 1.
  double Redundancy() const;
  /// ||z||^2 for each of those.
  double Variance() const { return residual.squaredNorm() / Redundancy(); }
  /// (J^T J)^-1.
  Eigen::MatrixXd Inverse() const;
};

/// Holds variables x that balance virtual work against the measured
/// displacements, which no virtual field weighs here: the model is solved at x,
/// and what is left at the minimum x' of the displacement misfit near it is
/// judged as that of a fit of displacements (DescribeMinimum,
/// DescribeMaterials), with what finer elements change.  x' is that of the
/// linear model u + S d where it is near (IsNearlyQuadratic), and else where a
/// descent leads.  Enters into the estimate
///
///   x - alpha b,   C = s^2 (J^T J)^-1 + var(alpha) b b^T + d d^T / 1.96^2
///                      + C' - s^2 (S^T S)^-1,
///
/// where s^2 is the variance of the noise that the displacements show; alpha
/// the part of the change to finer elements that is there, and b the bias that
/// displacements of those elements give the balance; d the difference to x',
/// corrected for finer elements too, which lies within each interval therefore
/// [the difference of an efficient and a robust estimate: Hausman, Econometrica
/// 46 (1978) 1251]; and C' the covariance of x' without that of its correction.
/// Where the balance is off by more than s^2 explains, ||z||^2 (J^T J)^-1 is
/// added.
///
/// Where supports leave motions without strain free, these are fitted.
///
/// Cost: a factorisation and a solve for each load case and variable, and those
/// of a descent where x' is not near; up to 30 000 simplices (120 000 in the
/// plane) two factorisations in quadratic ones.
/// Preconditions: all free components are observed; the parameters are entered.
void CheckByDisplacements(const Scene& scene, const EstimatorOptions& options,
                          const VirtualWork& work, const BalanceFit& fit,
                          const FreeParameters& free, Evidence& evidence,
                          Estimate& estimate);

}  // namespace elastimate

#endif  // ELASTIMATE_ESTIMATORS_FORCE_BALANCE_DISPLACEMENT_CHECK_H_
