#include "elastimate/estimators/statistics/errors_on_bound.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "elastimate/estimators/statistics/bounded_parameter.h"

namespace elastimate {
namespace {

// Root mean square of what a parameter that may be anywhere between its bounds
// is off one of them.
double DistanceFromBound(double lower, double upper) {
  return (upper - lower) / std::sqrt(3.0);
}

}  // namespace

ErrorsOnBound AllowForPoissonRatioOnBound(const EstimatorOptions& options,
                                          const ActiveBounds& active,
                                          double slope, double standard_error,
                                          Estimate& estimate) {
  const Bounds bounds = EffectivePoissonRatioBounds(options);
  const double error =
      std::min(standard_error, DistanceFromBound(*bounds.lower, *bounds.upper));
  const double youngs_modulus_error = std::abs(slope) * error;
  if (!active.is_physical_limit) {
    estimate.covariance(0, 0) +=
        std::pow(youngs_modulus_error * estimate.elasticity.youngs_modulus, 2);
  }
  return {standard_error, slope, youngs_modulus_error, error};
}

ErrorsOnBound AllowForYoungsModulusOnBound(const EstimatorOptions& options,
                                           double slope, double standard_error,
                                           Estimate& estimate) {
  const Bounds& bounds = options.youngs_modulus;
  const double distance =
      bounds.lower && bounds.upper
          ? DistanceFromBound(std::log(*bounds.lower), std::log(*bounds.upper))
          : std::numeric_limits<double>::infinity();
  const double error = std::min(standard_error, distance);
  const double poisson_ratio_error =
      options.known_poisson_ratio ? 0 : std::abs(slope) * error;
  estimate.covariance(1, 1) += poisson_ratio_error * poisson_ratio_error;
  return {standard_error, slope, error, poisson_ratio_error};
}

}  // namespace elastimate
