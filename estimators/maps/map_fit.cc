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
  if (!map.mesh_covariance.isZero(0)) {
    estimate.error_budget.discretization =
        map.mesh_covariance.diagonal().cwiseSqrt().cwiseQuotient(
            Eigen::Vector2d(map.mean_youngs_modulus, 1));
  }
  estimate.noise_sd = map.noise_sd;
  estimate.displacement_residual = map.displacement_residual;
  estimate.fitted_displacement = map.fitted_displacement;
  estimate.cameras = map.cameras;
  estimate.map = map;
  return estimate;
}

}  // namespace elastimate
