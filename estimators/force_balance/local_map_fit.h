#ifndef ELASTIMATE_ESTIMATORS_FORCE_BALANCE_LOCAL_MAP_FIT_H_
#define ELASTIMATE_ESTIMATORS_FORCE_BALANCE_LOCAL_MAP_FIT_H_

#include "elastimate/core/scene/scene.h"
#include "elastimate/estimators/interface/estimate.h"
#include "elastimate/estimators/interface/estimator.h"

namespace elastimate {

/// EstimateLocalMap as an estimate: its parameters are the geometric mean of E
/// over the volume and nu, without errors, and Estimate::map has the moduli,
/// with MapVerdict::kElements.  A finding says that noise makes them useless.
/// It fails where the equations do not determine all moduli, or where some are
/// not positive.  Preconditions are those of EstimateLocalMap.
[[nodiscard]] Estimate FitLocalMap(const Scene& scene,
                                   const EstimatorOptions& options);

}  // namespace elastimate

#endif  // ELASTIMATE_ESTIMATORS_FORCE_BALANCE_LOCAL_MAP_FIT_H_
