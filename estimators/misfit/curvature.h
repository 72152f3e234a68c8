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

/// What a covariance of the variables at x understates when a ratio ends close
/// to an end of its range, as nu does near 1/2.  Coarse elements become too
/// stiff there.  The misfit then has a narrow dip, whose width comes from the
/// mesh and not from the data.
///
/// For each such ratio, the misfit is evaluated with the ratio moved from x by
/// 1/32, 1/8 and 1/2 of the way to the other end, and all other variables
/// fitted again.  Let m be the move, and chi^2 the rise of the square sum over
/// that at `minimum`, in units of `variance`, that of a row.  Where chi^2 < 9,
/// the ratio may be off by m / sqrt(max(chi^2, 1)).  If the covariance says
/// less than the largest of these, the difference is added along m.
///
/// `minimum` is the minimum of `misfit`, whose elements may be coarser than
/// those that x was fitted with.  Without a ratio near an end this costs
/// nothing; else one evaluation, and one to four for each look.  Looks end
/// where chi^2 is 25.
Eigen::MatrixXd CovarianceAcrossRange(const Eigen::VectorXd& x,
                                      const Eigen::MatrixXd& covariance,
                                      double variance,
                                      const Eigen::VectorXd& minimum,
                                      DisplacementMisfit& misfit);

}  // namespace elastimate

#endif  // ELASTIMATE_ESTIMATORS_MISFIT_CURVATURE_H_
