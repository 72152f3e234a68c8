#ifndef ELASTIMATE_TESTS_ESTIMATORS_EVERY_ESTIMATOR_H_
#define ELASTIMATE_TESTS_ESTIMATORS_EVERY_ESTIMATOR_H_

#include <gtest/gtest.h>

#include <algorithm>
#include <string>
#include <string_view>

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

inline std::string EstimatorTestName(
    const ::testing::TestParamInfo<std::string_view>& estimator) {
  std::string name(estimator.param);
  std::replace(name.begin(), name.end(), '-', '_');
  return name;
}

}  // namespace elastimate::testing

#endif  // ELASTIMATE_TESTS_ESTIMATORS_EVERY_ESTIMATOR_H_
