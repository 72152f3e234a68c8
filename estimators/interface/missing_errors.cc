#include "elastimate/estimators/interface/missing_errors.h"

#include <cmath>
#include <string>

#include "elastimate/core/text/numbers.h"
#include "elastimate/estimators/interface/finding_sentences.h"

namespace elastimate {

void FailWithoutParameters(std::string_view estimator, const Scene& scene,
                           Estimate& estimate) {
  if (!estimate.IsUsable() || IsOneIsotropicMaterial(scene.materials)) {
    return;
  }
  const auto size = Eigen::Index(estimate.parameters.size());
  if (size == 0) {
    estimate.Fail(
        ErrorsMissing(std::string(estimator), "parameters of the materials"));
  } else if (estimate.parameter_covariance.rows() != size ||
             estimate.parameter_covariance.cols() != size) {
    estimate.Fail(ErrorsMissing(
        std::string(estimator),
        "a covariance of its " + Counted(std::size_t(size), "parameter")));
  }
}

void FailWithoutErrors(Estimate& estimate) {
  if (!estimate.IsUsable() || !estimate.why_no_standard_error.empty()) {
    return;
  }
  const Eigen::VectorXd variances = estimate.parameter_covariance.diagonal();
  for (Eigen::Index i = 0; i < variances.size(); ++i) {
    const ParameterEstimate& parameter = estimate.parameters[i];
    if (!parameter.is_known && std::isnan(variances(i))) {
      estimate.Fail(ErrorsMissing(estimate.estimator,
                                  "a standard error of " + parameter.Label()));
      return;
    }
  }
}

}  // namespace elastimate
