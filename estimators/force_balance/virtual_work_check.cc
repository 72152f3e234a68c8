#include "elastimate/estimators/force_balance/virtual_work_check.h"

#include "elastimate/estimators/force_balance/virtual_fields.h"
#include "elastimate/estimators/interface/limits.h"

namespace elastimate {

WorkCheck CheckByVirtualWork(const Scene& scene,
                             const EstimatorOptions& options,
                             Estimate& estimate) {
  if (!estimate.IsUsable() ||
      !(*estimate.force_residual > kLimits.small_force_residual)) {
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
    model = Eigen::Vector2d(
        0, options.known_poisson_ratio ? Estimate::kUnknown : 0);
    return WorkCheck::kIsNoise;
  }
  estimate.is_model_in_doubt = true;
  estimate.covariance += check.covariance;
  model = StandardErrors(check.covariance, estimate.elasticity);
  return WorkCheck::kIsMore;
}

}  // namespace elastimate
