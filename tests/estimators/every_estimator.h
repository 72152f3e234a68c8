#ifndef ELASTIMATE_TESTS_ESTIMATORS_EVERY_ESTIMATOR_H_
#define ELASTIMATE_TESTS_ESTIMATORS_EVERY_ESTIMATOR_H_

#include <gtest/gtest.h>

#include <algorithm>
#include <string>
#include <string_view>
#include <vector>

#include "elastimate/estimators/registry.h"

namespace elastimate::testing {

/// Noise small enough for the first-order statistics of any estimator.
constexpr double kSmallNoise = 1e-4;

/// Its tests run with the estimator that is their parameter.
class EveryEstimator : public ::testing::TestWithParam<std::string_view> {
 protected:
  Estimate Run(const Scene& scene, const EstimatorOptions& options = {}) const {
    return MakeEstimator(GetParam())->Run(scene, options);
  }
};

/// All estimators but some.
inline std::vector<std::string_view> EstimatorNamesBut(
    const std::vector<std::string_view>& others) {
  std::vector<std::string_view> names;
  for (const std::string_view name : EstimatorNames()) {
    if (std::find(others.begin(), others.end(), name) == others.end()) {
      names.push_back(name);
    }
  }
  return names;
}

inline std::string EstimatorTestName(
    const ::testing::TestParamInfo<std::string_view>& estimator) {
  std::string name(estimator.param);
  std::replace(name.begin(), name.end(), '-', '_');
  return name;
}

}  // namespace elastimate::testing

#endif  // ELASTIMATE_TESTS_ESTIMATORS_EVERY_ESTIMATOR_H_
