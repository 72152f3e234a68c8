#include "elastimate/estimators/force_balance/virtual_work_check.h"

#include <cmath>

#include "elastimate/core/materials/material_parameters.h"
#include "elastimate/estimators/force_balance/virtual_fields.h"
#include "elastimate/estimators/interface/limits.h"
#include "elastimate/estimators/interface/parameter_judge.h"

namespace elastimate {
namespace {

// Whether nothing else makes the estimate one that is not usable.
bool WouldBeUsable(Estimate estimate) {
  JudgeParameters(estimate);
  return estimate.IsUsable();
}

// The roots of the diagonal of a covariance of the parameters, in the units of
// the error budget; not numbers for those that are known.
ParameterErrors ErrorsOfParameters(const Eigen::MatrixXd& covariance,
                                   const Estimate& estimate) {
  ParameterErrors errors(covariance.rows());
  for (Eigen::Index i = 0; i < errors.size(); ++i) {
    errors(i) =
        std::sqrt(covariance(i, i)) / estimate.parameters[i].ErrorUnit();
  }
  return errors;
}

}  // namespace

WorkCheck CheckByVirtualWork(const Scene& scene,
                             const EstimatorOptions& options,
                             Estimate& estimate) {
  if (!(estimate.force_residual.value_or(0) > kLimits.small_force_residual) ||
      HasLargeStrainLaw(scene.materials, scene.mesh.section.model) ||
      !WouldBeUsable(estimate)) {
    return WorkCheck::kNotMade;
  }
  EstimatorOptions of_degree_one = options;
  of_degree_one.virtual_field_degree = 1;
  const Estimate check = VirtualFields().Run(scene, of_degree_one);
  estimate.work = estimate.work + check.work;
  if (!check.IsUsable()) {
    estimate.is_model_in_doubt = true;
    return WorkCheck::kContradicts;
  }
  ParameterErrors& model = estimate.error_budget.model;
  if (!check.is_model_in_doubt) {
    model = ErrorsOfParameters(0 * check.parameter_covariance, estimate);
    return WorkCheck::kIsNoise;
  }
  estimate.is_model_in_doubt = true;
  estimate.parameter_covariance += check.parameter_covariance;
  model = ErrorsOfParameters(check.parameter_covariance, estimate);
  return WorkCheck::kIsMore;
}

}  // namespace elastimate
