#ifndef ELASTIMATE_ESTIMATORS_MISFIT_ACROSS_RANGE_H_
#define ELASTIMATE_ESTIMATORS_MISFIT_ACROSS_RANGE_H_

#include <Eigen/Core>

#include "elastimate/estimators/misfit/displacement_misfit.h"

namespace elastimate {

/// What a covariance of the variables at x understates because values of a
/// ratio far from x fit about as well.  Two kinds of scenes have such values.
/// Close to an end of the range, as of nu near 1/2, coarse elements lock, and
/// make a narrow dip of the misfit, whose width comes from the mesh and not
/// from the data.  In bending, nu and -nu give nearly the same displacements.
///
/// The misfit is evaluated with the ratio moved from x by 1/32, 1/8 and 1/2 of
/// the way to the other end where x is within 2 % of the range of one end, by
/// 1/4, 1/2 and 3/4 of the way to either end where the error of the ratio is
/// above 2 % of the range and strains are small (a look at large ones takes
/// many factorisations).  All other variables are fitted again.  Let m be the
/// move, and chi^2 the rise of the square sum over that at `minimum`, in units
/// of `variance`, that of a row.  Where chi^2 < 9, the ratio may be off by
/// m / sqrt(max(chi^2, 1)).  If the covariance says less than the largest of
/// these, the difference is added along m.
///
/// `minimum` is the minimum of `misfit`, whose elements may be coarser than
/// those that x was fitted with.  Where no ratio is looked at this costs
/// nothing; else one evaluation, and one to four for each look.
Eigen::MatrixXd CovarianceAcrossRange(const Eigen::VectorXd& x,
                                      const Eigen::MatrixXd& covariance,
                                      double variance,
                                      const Eigen::VectorXd& minimum,
                                      DisplacementMisfit& misfit);

}  // namespace elastimate

#endif  // ELASTIMATE_ESTIMATORS_MISFIT_ACROSS_RANGE_H_
