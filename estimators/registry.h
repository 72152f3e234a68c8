#ifndef ELASTIMATE_ESTIMATORS_REGISTRY_H_
#define ELASTIMATE_ESTIMATORS_REGISTRY_H_

#include <memory>
#include <string_view>
#include <vector>

#include "elastimate/estimators/interface/estimator.h"

namespace elastimate {

/// The names of all estimators; the first is the default.
std::vector<std::string_view> EstimatorNames();

/// The estimator of this name.  Throws std::invalid_argument, listing the
/// known names, for any other.
std::unique_ptr<Estimator> MakeEstimator(std::string_view name);

}  // namespace elastimate

#endif  // ELASTIMATE_ESTIMATORS_REGISTRY_H_
