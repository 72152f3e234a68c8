#ifndef ELASTIMATE_ESTIMATORS_INTERFACE_PRIORS_H_
#define ELASTIMATE_ESTIMATORS_INTERFACE_PRIORS_H_

#include "elastimate/core/scene/scene.h"
#include "elastimate/estimators/interface/estimate.h"
#include "elastimate/estimators/interface/estimator.h"

namespace elastimate {

/// Combines an estimate with the priors of the materials (Material::priors).
/// In ln p for moduli and in p for ratios, the estimate y with its covariance C
/// from all causes and the priors y_0 with their covariance P are independent
/// and normal, so that with K = C (C + P)^-1
///
///   y + K (y_0 - y)   has the covariance   (1 - K) C.
///
/// What each cause adds to the errors is scaled with it, and the part
/// K P K^T of the covariance is that of the priors (ErrorBudget::prior).  Where
/// (y_0 - y)^T (C + P)^-1 (y_0 - y) is larger than chance makes it once in a
/// hundred times, the finding `prior_contradicted` says so.
///
/// The result is moved into the bounds that are given, and into the range of
/// Poisson's ratio.
///
/// An estimate that is not usable, or that has been through this, stays as it
/// is.  O(m^3) for m parameters.  [Tarantola, Inverse Problem Theory (2005),
/// section 3.2]
void ApplyPriors(const Scene& scene, const EstimatorOptions& options,
                 Estimate& estimate);

}  // namespace elastimate

#endif  // ELASTIMATE_ESTIMATORS_INTERFACE_PRIORS_H_
