#include "elastimate/estimators/maps/map_fit.h"

#include "elastimate/estimators/maps/estimate_map.h"

namespace elastimate {

Estimate FitMap(const Scene& scene, const EstimatorOptions& options) {
  const MapEstimate map = EstimateMap(scene, options);
  Estimate estimate;
  estimate.element_order = map.element_order;
  estimate.work = map.work;
  if (!map.IsUsable()) {
    estimate.Fail(map.findings.back());
    return estimate;
  }
  estimate.Accept();
  for (const Finding& finding : map.findings) {
    estimate.Add(finding);
  }
  estimate.elasticity = {map.mean_youngs_modulus, map.poisson_ratio};
  estimate.covariance = map.covariance;
  if (options.known_poisson_ratio) {
    estimate.covariance.row(1).setConstant(Estimate::kUnknown);
    estimate.covariance.col(1).setConstant(Estimate::kUnknown);
  }
  estimate.noise_sd = map.noise_sd;
  estimate.map = map;
  return estimate;
}

}  // namespace elastimate
