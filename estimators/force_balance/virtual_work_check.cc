#include "elastimate/estimators/force_balance/virtual_work_check.h"

#include "elastimate/estimators/force_balance/virtual_fields.h"
#include "elastimate/estimators/interface/finding_sentences.h"
#include "elastimate/estimators/interface/limits.h"

namespace elastimate {

void CheckByVirtualWork(const Scene& scene, const EstimatorOptions& options,
                        Estimate& estimate) {
  if (!estimate.IsUsable() ||
      !(*estimate.force_residual > kLimits.small_force_residual)) {
    return;
  }
  EstimatorOptions of_degree_one = options;
  of_degree_one.virtual_field_degree = 1;
  const Estimate check = VirtualFields().Run(scene, of_degree_one);
  estimate.work = estimate.work + check.work;
  if (check.IsUsable() && !check.is_model_in_doubt) {
    estimate.error_budget.model.youngs_modulus = 0;
    if (!options.known_poisson_ratio) {
      estimate.error_budget.model.poisson_ratio = 0;
    }
    return;
  }
  estimate.is_model_in_doubt = true;
  if (check.IsUsable()) {
    estimate.covariance += check.covariance;
    estimate.error_budget.model =
        StandardErrors(check.covariance, estimate.elasticity);
    estimate.Add(
        VirtualWorkImbalance(*estimate.force_residual, Severity::kWarning));
    return;
  }
  estimate.Fail(
      VirtualWorkImbalance(*estimate.force_residual, Severity::kError));
}

}  // namespace elastimate
