#ifndef ELASTIMATE_ESTIMATORS_DISPLACEMENT_FIT_SUPPORT_END_SEARCH_H_
#define ELASTIMATE_ESTIMATORS_DISPLACEMENT_FIT_SUPPORT_END_SEARCH_H_

#include <functional>

#include "elastimate/core/scene/scene.h"
#include "elastimate/estimators/displacement_fit/displacement_fit.h"
#include "elastimate/estimators/interface/estimate.h"
#include "elastimate/estimators/interface/estimator.h"

namespace elastimate {

/// A fit of displacements on supports without open ends.
using SupportedFit =
    std::function<Estimate(const Scene& scene, const SupportDoubt& doubt)>;

/// Fits a scene whose supports may end within elements (Supports::ends): finds
/// the ends that leave the least sum of squares, and fits with these, and with
/// the doubt that other ends leave.  Without such ends, the fit alone.
///
/// A cut says how many steps of each end are held.  From the fit without any,
/// each cut that is looked at takes some Gauss-Newton steps in (E, nu), the
/// first from the nearest cut before.  The gaps on either side of the best are
/// halved, until they are single steps or less than the range of Delta chi^2 <=
/// 9, which takes residuals as linear between cuts: the noise hides more.
/// Ends take turns.
///
/// With residuals r + D x at the best cut, x steps further along the ends, and
/// parameters that follow by T x, the doubt is that of the posterior of x:
///
///   C = (D^T D / s^2 + P)^-1,  mean = C (P x_0 - D^T r / s^2),
///
/// with s^2 the mean square of r, or that of the given noise where it is more,
/// and P and x_0 the inverse variances and means of ends that are as likely
/// anywhere between held and free vertices, the middles half way.
/// Of more ends than four, the smallest are held or free together.  A fit
/// without any of them that is not physical is returned as it is.
///
/// Cost: two fits, and a factorisation of the quadratic elements, or two, for
/// each cut: three for an end that the noise hides, a dozen for one of many
/// steps, and 24 for each end at most.
Estimate FitAndFindSupportEnds(const Scene& scene,
                               const EstimatorOptions& options,
                               const SupportedFit& fit);

}  // namespace elastimate

#endif  // ELASTIMATE_ESTIMATORS_DISPLACEMENT_FIT_SUPPORT_END_SEARCH_H_
