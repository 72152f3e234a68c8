#ifndef ELASTIMATE_ESTIMATORS_INTERFACE_RULES_H_
#define ELASTIMATE_ESTIMATORS_INTERFACE_RULES_H_

#include <vector>

#include "elastimate/estimators/interface/estimate.h"
#include "elastimate/estimators/interface/estimator.h"
#include "elastimate/estimators/interface/evidence.h"
#include "elastimate/estimators/interface/finding.h"

namespace elastimate {

/// What all rules about evidence find of an estimate, in the order in which
/// they are applied: of several errors the first is the reason of the status.
std::vector<Finding> ApplyRules(const Evidence& evidence,
                                const EstimatorOptions& options,
                                const Estimate& estimate);

/// Whether one of some errors of the parameters, in their order and units of
/// errors, is more than a part of its standard error that a user wants to be
/// told of.  Errors that are not numbers are not notable.
bool AreNotable(const ParameterErrors& errors, const Estimate& estimate);

}  // namespace elastimate

#endif  // ELASTIMATE_ESTIMATORS_INTERFACE_RULES_H_
