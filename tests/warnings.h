#ifndef ELASTIMATE_TESTS_WARNINGS_H_
#define ELASTIMATE_TESTS_WARNINGS_H_

#include <algorithm>
#include <string>

#include "elastimate/estimators/interface/estimate.h"

namespace elastimate::testing {

/// Whether a warning contains these words.
inline bool WarnsOf(const Estimate& estimate, const std::string& words) {
  return std::any_of(estimate.warnings.begin(), estimate.warnings.end(),
                     [&words](const std::string& warning) {
                       return warning.find(words) != std::string::npos;
                     });
}

}  // namespace elastimate::testing

#endif  // ELASTIMATE_TESTS_WARNINGS_H_
