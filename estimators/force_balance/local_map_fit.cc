#include "elastimate/estimators/force_balance/local_map_fit.h"

#include <Eigen/Core>
#include <cmath>

#include "elastimate/core/mesh/mesh.h"
#include "elastimate/estimators/force_balance/local_map.h"
#include "elastimate/estimators/interface/finding_sentences.h"
#include "elastimate/estimators/interface/map_estimate.h"

namespace elastimate {

Estimate FitLocalMap(const Scene& scene, const EstimatorOptions& options) {
  const LocalMap local = EstimateLocalMap(scene, options);
  const Eigen::VectorXd& moduli = local.youngs_modulus;
  Estimate estimate;
  estimate.elasticity.poisson_ratio = local.poisson_ratio;
  const Eigen::Index num_positive = (moduli.array() > 0).count();
  if (!local.is_determined) {
    estimate.Fail(LocalMapUndetermined());
    return estimate;
  }
  if (num_positive < moduli.size()) {
    estimate.Fail(
        LocalModuliNotPositive(moduli.size() - num_positive, moduli.size()));
    return estimate;
  }
  estimate.Accept();
  estimate.Add(LocalMapNeedsExactData(local.force_residual));
  estimate.why_no_standard_error =
      "a map that takes each element by itself has none";
  const Eigen::VectorXd volumes = ElementVolumes(scene.mesh);
  MapEstimate map;
  map.status = Status::kOk;
  map.verdict = MapVerdict::kElements;
  map.field_log_evidence = Estimate::kUnknown;
  map.region_log_evidence = Estimate::kUnknown;
  map.supported_parameters = Estimate::kUnknown;
  map.youngs_modulus = moduli;
  map.mean_youngs_modulus =
      std::exp(volumes.dot(moduli.array().log().matrix()) / volumes.sum());
  map.poisson_ratio = local.poisson_ratio;
  estimate.elasticity.youngs_modulus = map.mean_youngs_modulus;
  estimate.map = map;
  return estimate;
}

}  // namespace elastimate
