#include "elastimate/estimators/force_balance/virtual_work_check.h"

#include <sstream>

#include "elastimate/estimators/force_balance/virtual_fields.h"
#include "elastimate/estimators/interface/statistics.h"

namespace elastimate {

void CheckByVirtualWork(const Scene& scene, const EstimatorOptions& options,
                        Estimate& estimate) {
  constexpr double kSmallResidual = 0.1;
  if (!estimate.IsUsable() || !(*estimate.force_residual > kSmallResidual)) {
    return;
  }
  EstimatorOptions of_degree_one = options;
  of_degree_one.virtual_field_degree = 1;
  const Estimate check = VirtualFields().Run(scene, of_degree_one);
  estimate.work = estimate.work + check.work;
  if (check.IsUsable() && !check.is_model_in_doubt) {
    return;
  }
  estimate.is_model_in_doubt = true;
  std::ostringstream text;
  text << "the force residual is " << TwoDigits(*estimate.force_residual)
       << " of the load, and virtual work (virtual-fields) shows more than "
          "noise in it: the mesh, the supports, the loads, a bound or a given "
          "Poisson's ratio do not describe the experiment";
  if (check.IsUsable()) {
    estimate.covariance += check.covariance;
    estimate.warnings.push_back(text.str() +
                                "; the standard errors are widened by those of "
                                "virtual-fields");
    return;
  }
  estimate.Fail(Status::kNotIdentifiable, text.str(),
                "the model contradicts the data");
}

}  // namespace elastimate
