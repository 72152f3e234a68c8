#ifndef ELASTIMATE_APPS_VALIDATION_SUMMARY_H_
#define ELASTIMATE_APPS_VALIDATION_SUMMARY_H_

#include <string>
#include <vector>

#include "elastimate/estimators/validation/cross_validation.h"
#include "elastimate/estimators/validation/folds.h"

namespace elastimate {

/// Returns the cross-validations of some models, by name, as a text for people:
/// a table of the folds for the first model, a table of models if there are
/// several, and a sentence on what it means.
std::string ValidationSummary(const Folds& folds,
                              const std::vector<std::string>& models,
                              const std::vector<CrossValidation>& validations);

}  // namespace elastimate

#endif  // ELASTIMATE_APPS_VALIDATION_SUMMARY_H_
