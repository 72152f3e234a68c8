#include "elastimate/estimators/statistics/error_propagation.h"

#include <cmath>
#include <optional>

namespace elastimate {
namespace {

// Of two parameters; what is not known of another counts where that adds to
// them.
double Propagated(const Eigen::Matrix2d& propagation, int i, int j,
                  const Eigen::Matrix2d& covariance) {
  double sum = 0;
  for (int k = 0; k < 2; ++k) {
    for (int l = 0; l < 2; ++l) {
      const double factor = propagation(i, k) * propagation(j, l);
      if (factor != 0) {
        sum += factor * covariance(k, l);
      }
    }
  }
  return sum;
}

ParameterErrors Propagated(const Eigen::Matrix2d& propagation,
                           const Eigen::Vector2d& errors) {
  Eigen::Matrix2d covariance = Eigen::Matrix2d::Zero();
  covariance.diagonal() = errors.cwiseAbs2();
  return Eigen::Vector2d(std::sqrt(Propagated(propagation, 0, 0, covariance)),
                         std::sqrt(Propagated(propagation, 1, 1, covariance)));
}

}  // namespace

void PropagateErrors(const Eigen::Matrix2d& propagation, Estimate& estimate) {
  const double youngs_modulus = estimate.elasticity.youngs_modulus;
  Eigen::Matrix2d scaled = propagation;
  scaled(0, 1) *= youngs_modulus;
  scaled(1, 0) /= youngs_modulus;
  const Eigen::Matrix2d covariance = estimate.covariance;
  for (int i = 0; i < 2; ++i) {
    for (int j = 0; j < 2; ++j) {
      estimate.covariance(i, j) = Propagated(scaled, i, j, covariance);
    }
  }
  ErrorBudget& budget = estimate.error_budget;
  for (ParameterErrors* part :
       {&budget.noise, &budget.model, &budget.outliers}) {
    if (part->size() == 2) {
      *part = Propagated(propagation, *part);
    }
  }
  std::optional<double>& of_youngs_modulus = estimate.discretization_error;
  std::optional<double>& of_poisson_ratio =
      estimate.poisson_ratio_discretization_error;
  const ParameterErrors elements =
      Propagated(propagation, {of_youngs_modulus.value_or(Estimate::kUnknown),
                               of_poisson_ratio.value_or(Estimate::kUnknown)});
  if (of_youngs_modulus) {
    of_youngs_modulus = elements(0);
  }
  if (of_poisson_ratio) {
    of_poisson_ratio = elements(1);
  }
}

}  // namespace elastimate
