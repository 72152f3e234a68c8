#ifndef ELASTIMATE_ESTIMATORS_INTERFACE_JUDGE_H_
#define ELASTIMATE_ESTIMATORS_INTERFACE_JUDGE_H_

#include <string_view>
#include <vector>

#include "elastimate/core/scene/scene.h"
#include "elastimate/estimators/interface/estimate.h"
#include "elastimate/estimators/interface/estimator.h"
#include "elastimate/estimators/interface/evidence.h"

namespace elastimate {

/// Applies all rules (rules.h) to what a method measured: enters what they find
/// into `estimate`, and makes it usable or, for the first error, not usable.
/// May be called again when the method has measured more.  Why a parameter has
/// no standard error is said where it lies on a bound.
void Judge(const Evidence& evidence, const EstimatorOptions& options,
           Estimate& estimate);

/// Enters the estimator's name, the findings of its input, and what follows
/// from the parameters and their covariance: the errors of other causes,
/// standard errors and intervals.  Warns of a mesh error that is notable or
/// unknown, and turns an estimate that claims to be ok into what it is, when it
/// is not finite, not physical, not determined, or without errors or a reason
/// for that.
void FinishEstimate(std::string_view estimator, const Scene& scene,
                    const EstimatorOptions& options,
                    const std::vector<Finding>& findings, Estimate& estimate);

}  // namespace elastimate

#endif  // ELASTIMATE_ESTIMATORS_INTERFACE_JUDGE_H_
