#ifndef ELASTIMATE_ESTIMATORS_INTERFACE_INPUT_CHECKS_H_
#define ELASTIMATE_ESTIMATORS_INTERFACE_INPUT_CHECKS_H_

#include <vector>

#include "elastimate/core/scene/scene.h"
#include "elastimate/estimators/interface/estimator.h"
#include "elastimate/estimators/interface/finding.h"

namespace elastimate {

/// Throws std::invalid_argument unless the options are valid.
void CheckOptions(const EstimatorOptions& options);

/// Throws std::invalid_argument unless `estimator` supports a valid scene and
/// valid options.
void CheckSupported(const Estimator& estimator, const Scene& scene,
                    const EstimatorOptions& options);

/// Throws std::invalid_argument unless every load case of a valid scene has
/// what each estimator needs: see Estimator::Run.  Returns warnings, at
/// most one of each code.
std::vector<Finding> CheckMeasurements(const Scene& scene);

/// Checks the loads likewise, and what is said about noise.
void CheckLoads(const Scene& scene);

}  // namespace elastimate

#endif  // ELASTIMATE_ESTIMATORS_INTERFACE_INPUT_CHECKS_H_
