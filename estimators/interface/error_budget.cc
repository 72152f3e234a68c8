#include "elastimate/estimators/interface/error_budget.h"

#include <cmath>

namespace elastimate {

ParameterErrors StandardErrors(const Eigen::Matrix2d& covariance,
                               const IsotropicElasticity& elasticity) {
  return Eigen::Vector2d(
      std::sqrt(covariance(0, 0)) / elasticity.youngs_modulus,
      std::sqrt(covariance(1, 1)));
}

}  // namespace elastimate
