#ifndef ELASTIMATE_ESTIMATORS_REGISTRY_H_
#define ELASTIMATE_ESTIMATORS_REGISTRY_H_

#include <memory>
#include <string_view>
#include <vector>

#include "elastimate/estimators/interface/estimator.h"

namespace elastimate {

/// Returns the names of all estimators: those of the library, the first of
/// which is the default, then those of RegisterEstimator.  The views stay valid
/// until the program ends.  May be called from several threads at once.
[[nodiscard]] std::vector<std::string_view> EstimatorNames();

/// Returns the estimator of this name.  All callers share one, which keeps
/// nothing between its calls.  Throws std::invalid_argument, listing the known
/// names, for any other name.  May be called from several threads at once.
[[nodiscard]] std::shared_ptr<const Estimator> MakeEstimator(
    std::string_view name);

/// Adds an estimator of the calling program, which EstimatorNames and
/// MakeEstimator know from then on:
///
///   RegisterEstimator(std::make_shared<MyEstimator>());
///
/// Throws std::invalid_argument, and adds nothing, when the pointer is null,
/// the name is empty, or an estimator of that name is there already.  May be
/// called from several threads at once.
void RegisterEstimator(std::shared_ptr<const Estimator> estimator);

}  // namespace elastimate

#endif  // ELASTIMATE_ESTIMATORS_REGISTRY_H_
