#include "elastimate/estimators/element_order.h"

#include <algorithm>
#include <cmath>
#include <optional>

#include "elastimate/core/algebra/node_sums.h"
#include "elastimate/core/scene/observed_displacements.h"
#include "elastimate/estimators/interface/limits.h"
#include "elastimate/estimators/statistics/profile_likelihood.h"
#include "elastimate/estimators/statistics/residual_statistics.h"

namespace elastimate {
namespace {

constexpr double kLikely = 0.95;

// What fits of a scene of different orders are held against.
struct Observations {
  Eigen::Index redundancy;  // Rows without those that fix the parameters.
  /// Of all rows over their noise; empty where that is not given.
  std::optional<double> norm_over_noise;

  Observations(const Scene& scene, const EstimatorOptions& options) {
    const ObservedDisplacements observed(scene);
    redundancy = std::max<Eigen::Index>(
        observed.Size() - (options.known_poisson_ratio ? 1 : 2), 0);
    if (observed.GivenNoise()) {
      norm_over_noise = observed.Norm() * Norm(observed.Measured());
    }
  }
};

// Twice the difference of the logarithms of the likelihoods of two fits of as
// many parameters, if the rows are independent.
double Gain(const Estimate& one, const Estimate& other,
            const Observations& observations) {
  if (!one.bounded_residual || !other.bounded_residual ||
      *one.bounded_residual == *other.bounded_residual) {
    return 0;
  }
  return observations.norm_over_noise
             ? std::pow(*observations.norm_over_noise, 2) *
                   (std::pow(*other.bounded_residual, 2) -
                    std::pow(*one.bounded_residual, 2))
             : -2 * static_cast<double>(observations.redundancy) *
                   std::log(*one.bounded_residual / *other.bounded_residual);
}

bool ExplainsFarBetter(const Estimate& one, const Estimate& other,
                       double gain) {
  if (!one.bounded_residual || !other.bounded_residual) {
    return one.bounded_residual.has_value();
  }
  return one.is_model_in_doubt
             ? *one.bounded_residual <=
                   kLimits.far_better_residual * *other.bounded_residual
             : gain > kLimits.significant_score * kLimits.significant_score;
}

// An estimate without the correction for what its elements miss.
IsotropicElasticity Uncorrected(const Estimate& estimate) {
  const Eigen::Vector2d correction =
      estimate.discretization_correction.value_or(Eigen::Vector2d::Zero());
  return {estimate.elasticity.youngs_modulus / (1 + correction(0)),
          estimate.elasticity.poisson_ratio - correction(1)};
}

}  // namespace

OrderComparison::OrderComparison(const Scene& scene,
                                 const EstimatorOptions& options,
                                 const Estimate& linear,
                                 const Estimate& quadratic)
    : by_linear_(Uncorrected(linear)) {
  const double gain = Gain(linear, quadratic, Observations(scene, options));
  is_linear_far_better_ = ExplainsFarBetter(linear, quadratic, gain);
  is_quadratic_far_better_ = ExplainsFarBetter(quadratic, linear, -gain);
  const double correlation =
      std::min(linear.residual_correlation.value_or(0),
               quadratic.residual_correlation.value_or(0));
  probability_of_linear_ =
      1 / (1 + std::exp(-gain / RowsForOne(correlation) / 2));
}

bool OrderComparison::IsLinearLikely() const {
  return probability_of_linear_ > kLikely;
}

bool OrderComparison::IsQuadraticLikely() const {
  return probability_of_linear_ < 1 - kLikely;
}

void OrderComparison::HoldLinear(Estimate& quadratic) const {
  const Eigen::Vector2d change(
      by_linear_.youngs_modulus - quadratic.elasticity.youngs_modulus,
      by_linear_.poisson_ratio - quadratic.elasticity.poisson_ratio);
  const double p = probability_of_linear_;
  quadratic.covariance += p * (change * change.transpose());
  const auto add = [p](double what, double& error) {
    error = std::hypot(error, std::sqrt(p) * what);
  };
  if (quadratic.discretization_error) {
    add(change(0) / quadratic.elasticity.youngs_modulus,
        *quadratic.discretization_error);
  }
  if (quadratic.poisson_ratio_discretization_error) {
    add(change(1), *quadratic.poisson_ratio_discretization_error);
  }
  WidenInterval(p * change(1) * change(1), quadratic);
}

}  // namespace elastimate
