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

/// Whether the discretisation error is larger than 1 % and than half a standard
/// error of E, or that of nu than 0.01 and half its standard error.
bool IsDiscretizationErrorNotable(const Estimate& estimate);

/// Enters the estimator's name, the findings of its input, and an interval of
/// nu where only its standard error is known; warns of a mesh error that is
/// notable or unknown; and turns an estimate
/// that claims to be ok into what it is, when it is not finite, not physical,
/// or not determined.
void FinishEstimate(std::string_view estimator, const Scene& scene,
                    const EstimatorOptions& options,
                    const std::vector<Finding>& findings, Estimate& estimate);

}  // namespace elastimate

#endif  // ELASTIMATE_ESTIMATORS_INTERFACE_JUDGE_H_
