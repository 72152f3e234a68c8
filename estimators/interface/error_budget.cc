#include "elastimate/estimators/interface/error_budget.h"

#include <cmath>

namespace elastimate {

ParameterErrors StandardErrors(const Eigen::Matrix2d& covariance,
                               const IsotropicElasticity& elasticity) {
  const auto root = [](double variance, double scale) {
    const double error = std::sqrt(variance) / scale;
    return std::isfinite(error) ? std::optional<double>(error) : std::nullopt;
  };
  return {root(covariance(0, 0), elasticity.youngs_modulus),
          root(covariance(1, 1), 1)};
}

}  // namespace elastimate
