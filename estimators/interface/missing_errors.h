#ifndef ELASTIMATE_ESTIMATORS_INTERFACE_MISSING_ERRORS_H_
#define ELASTIMATE_ESTIMATORS_INTERFACE_MISSING_ERRORS_H_

#include <string_view>

#include "elastimate/core/scene/scene.h"
#include "elastimate/estimators/interface/estimate.h"

namespace elastimate {

/// Makes an estimate that claims to be usable a failure where the scene has
/// other materials than one isotropic one, and the estimate no parameters, or a
/// covariance that is not as large as these are many.  To be called before
/// FinishEstimate, which reads both.  O(1).
void FailWithoutParameters(std::string_view estimator, const Scene& scene,
                           Estimate& estimate);

/// Makes an estimate that claims to be usable a failure where the variance of a
/// parameter that it estimates is not a number, and `why_no_standard_error` is
/// empty: nobody could tell how far to trust the value.  O(number of
/// parameters).
void FailWithoutErrors(Estimate& estimate);

}  // namespace elastimate

#endif  // ELASTIMATE_ESTIMATORS_INTERFACE_MISSING_ERRORS_H_
