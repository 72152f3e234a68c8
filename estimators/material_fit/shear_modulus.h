#ifndef ELASTIMATE_ESTIMATORS_MATERIAL_FIT_SHEAR_MODULUS_H_
#define ELASTIMATE_ESTIMATORS_MATERIAL_FIT_SHEAR_MODULUS_H_

#include <functional>

#include "elastimate/core/scene/scene.h"
#include "elastimate/estimators/interface/estimate.h"
#include "elastimate/estimators/interface/estimator.h"

namespace elastimate {

/// Fits the scene with other options.
using FitWithOptions = std::function<Estimate(const EstimatorOptions&)>;

/// Looks for the shear modulus where the data determine neither E nor nu of one
/// isotropic material.  In torsion, each nu has its own E, and all of them have
/// nearly the same
///
///   mu = E(nu) / (2 (1 + nu)).
///
/// E is fitted with nu given at three values: one standard error below the
/// estimate, one above it, and between them.  Where nu has no standard error,
/// the whole range takes its place.  Values that the data contradict do not
/// count.  mu is the geometric mean of the largest and the smallest; its
/// standard error is half of their distance and the largest error that a fit
/// has.  Where this is small enough (Limits), the estimate becomes usable, and
/// parameters without a standard error get the distance to the furthest of the
/// three fits for it.
///
/// Does nothing to scenes with bounds, priors or several materials, to
/// estimates that are usable, and to those that are refused for another reason.
/// Costs three fits of one parameter.
void FindShearModulus(const Scene& scene, const EstimatorOptions& options,
                      const FitWithOptions& fit, Estimate& estimate);

}  // namespace elastimate

#endif  // ELASTIMATE_ESTIMATORS_MATERIAL_FIT_SHEAR_MODULUS_H_
