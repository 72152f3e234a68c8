#ifndef ELASTIMATE_ESTIMATORS_MISFIT_CURVATURE_H_
#define ELASTIMATE_ESTIMATORS_MISFIT_CURVATURE_H_

#include <Eigen/Core>

#include "elastimate/estimators/misfit/displacement_misfit.h"

namespace elastimate {

/// What a covariance C of the variables at a minimum x understates, because the
/// misfit is not quadratic as far as C reaches.
///
/// Looked at are the combinations a^T x of the variables that are known worst,
/// those of the largest eigenvalues of the covariance of the parameters, of
/// stiffnesses relative, of ratios over the way to the nearer end of their
/// range.  Each is moved by two standard errors to either side,
/// m = +- 2 C a / sqrt(a^T C a), and the square sum of the residual is taken
/// there at the least over all other combinations, by a Gauss-Newton step,
/// which is taken where it gains much. Where it is only a part p of what a
/// quadratic misfit would rise to, the error is 1 / sqrt(p) times as large: (1
/// / p - 1) m m^T / 4 is added.  Where the square sum rises to less than 0.6 of
/// what two standard errors mean, as around a dip next to nu = 1/2, the move is
/// lengthened until it does, four times at most, and p is that of the last.
/// Where the others are off those of the linear model by b there, as E of a
/// bent plate, which does not change with nu to first order, diag(b^2) / 4 is
/// added.
///
/// Nothing is added where all errors are small, which costs nothing, or so
/// large that the parameter is not determined anyway; else each of at most two
/// combinations takes two to four evaluations of the misfit, a factorisation
/// each, for each look.  `beforehand` is the diagonal of what is known without
/// the rows of the misfit, in the unit of S^T S, S being their derivatives at
/// x. Where x is not a minimum of the misfit, the rise is that beyond its
/// slope.
///
/// See Seber & Wild, Nonlinear Regression, 1989, section 5.2.
Eigen::MatrixXd CovarianceOfCurvature(const Eigen::VectorXd& x,
                                      const Eigen::MatrixXd& covariance,
                                      const Eigen::VectorXd& beforehand,
                                      DisplacementMisfit& misfit);

}  // namespace elastimate

#endif  // ELASTIMATE_ESTIMATORS_MISFIT_CURVATURE_H_
