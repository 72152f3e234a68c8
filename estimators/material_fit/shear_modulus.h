#ifndef ELASTIMATE_ESTIMATORS_MATERIAL_FIT_SHEAR_MODULUS_H_
#define ELASTIMATE_ESTIMATORS_MATERIAL_FIT_SHEAR_MODULUS_H_

#include <functional>

#include "elastimate/core/scene/scene.h"
#include "elastimate/estimators/interface/estimate.h"
#include "elastimate/estimators/interface/estimator.h"

namespace elastimate {

/// Fits the scene with other options.
using FitWithOptions = std::function<Estimate(const EstimatorOptions&)>;

/// Looks for the shear modulus of one isotropic material whose nu the estimate
/// does not determine, and E to no better than 5 %.  In torsion, each nu has
/// its own E, and all of them have nearly the same
///
///   mu = E(nu) / (2 (1 + nu)).
///
/// E is fitted with nu given at three values: one standard error below the
/// estimate, one above it, and between them, all of them from -0.9 to 0.49.
/// Where nu has no standard error, they span that whole range.  Values that the
/// data contradict do not count; if a fit is not usable or misses something
/// smooth, nothing is found.  mu is the geometric mean of its largest and its
/// smallest value; the square of its relative standard error is that of half of
/// their distance, in logarithms, plus the largest that a fit has.  If it is
/// determined (Limits), and better known than E, the estimate becomes usable
/// with it.  An error of E or nu that is not known becomes the distance to the
/// fit whose nu is furthest.
///
/// Returns whether it has looked, so that E and nu are no place to start
/// another fit from.  Does nothing, and returns false, for scenes with bounds,
/// priors, known parameters or several materials, and for estimates that are
/// refused for another reason.  Costs three fits of one parameter.
bool FindShearModulus(const Scene& scene, const EstimatorOptions& options,
                      const FitWithOptions& fit, Estimate& estimate);

}  // namespace elastimate

#endif  // ELASTIMATE_ESTIMATORS_MATERIAL_FIT_SHEAR_MODULUS_H_
