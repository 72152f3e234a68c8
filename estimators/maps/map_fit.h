#ifndef ELASTIMATE_ESTIMATORS_MAPS_MAP_FIT_H_
#define ELASTIMATE_ESTIMATORS_MAPS_MAP_FIT_H_

#include "elastimate/core/scene/scene.h"
#include "elastimate/estimators/interface/estimate.h"
#include "elastimate/estimators/interface/estimator.h"

namespace elastimate {

/// EstimateMap as an estimate: its parameters are the geometric mean of E over
/// the volume and nu, and Estimate::map has the rest.  Preconditions are those
/// of EstimateMap.
[[nodiscard]] Estimate FitMap(const Scene& scene,
                              const EstimatorOptions& options);

}  // namespace elastimate

#endif  // ELASTIMATE_ESTIMATORS_MAPS_MAP_FIT_H_
