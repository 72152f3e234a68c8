#ifndef ELASTIMATE_IO_REPORT_VALIDATION_REPORT_H_
#define ELASTIMATE_IO_REPORT_VALIDATION_REPORT_H_

#include <string>
#include <vector>

#include "elastimate/estimators/validation/cross_validation.h"
#include "elastimate/estimators/validation/folds.h"

namespace elastimate {

/// Returns the cross-validations of some models, by name, as a JSON object
/// (docs/validation.md).  What is not known is null.
[[nodiscard]] std::string JsonValidation(
    const Folds& folds, const std::vector<std::string>& models,
    const std::vector<CrossValidation>& validations,
    const std::vector<std::string>& notices);

}  // namespace elastimate

#endif  // ELASTIMATE_IO_REPORT_VALIDATION_REPORT_H_
