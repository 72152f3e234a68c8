#include "elastimate/estimators/interface/priors.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <optional>
#include <vector>

#include "elastimate/core/algebra/dense_algebra.h"
#include "elastimate/estimators/interface/finding_sentences.h"
#include "elastimate/estimators/interface/free_parameters.h"
#include "elastimate/estimators/interface/statistics.h"

namespace elastimate {
namespace {

/// The priors of the parameters that are estimated, in the units of errors.
struct Priors {
  std::vector<Eigen::Index> places;  // Among the estimated parameters.
  Eigen::VectorXd distance;          // From the estimate, y_0 - y.
  Eigen::VectorXd variance;          // The diagonal of P.
};

Priors PriorsOf(const FreeParameters& free, const Estimate& estimate) {
  Priors priors;
  std::vector<double> distance;
  std::vector<double> variance;
  for (Eigen::Index k = 0; k < free.Size(); ++k) {
    const ParameterEstimate& of = estimate.parameters[free.All().Free()[k]];
    const std::optional<Prior>& prior = free.Free(k).prior;
    if (prior) {
      priors.places.push_back(k);
      distance.push_back(of.is_modulus
                             ? std::log(prior->value / of.value)
                             : (prior->value - of.value) / of.ErrorUnit());
      variance.push_back(std::pow(
          prior->sd / (of.is_modulus ? prior->value : of.ErrorUnit()), 2));
    }
  }
  priors.distance = Eigen::VectorXd::Map(distance.data(), distance.size());
  priors.variance = Eigen::VectorXd::Map(variance.data(), variance.size());
  return priors;
}

Eigen::VectorXd UnitsOf(const Estimate& estimate,
                        const std::vector<Eigen::Index>& estimated) {
  Eigen::VectorXd units(estimated.size());
  for (std::size_t k = 0; k < estimated.size(); ++k) {
    units(k) = estimate.parameters[estimated[k]].ErrorUnit();
  }
  return units;
}

// Changes a parameter by `change` in the units of errors, within the bounds of
// its variable: the linear combination knows no ends of ranges.
void Move(double change, const Bounds& bounds, ParameterEstimate& parameter) {
  const double unit = parameter.ErrorUnit();
  double y = change + (parameter.is_modulus ? std::log(parameter.value)
                                            : parameter.value / unit);
  y = std::max(y, bounds.lower.value_or(y));
  y = std::min(y, bounds.upper.value_or(y));
  parameter.value = parameter.is_modulus ? std::exp(y) : y * unit;
}

// Scales the parts of the errors as the errors from all causes change.
void EnterBudget(const std::vector<Eigen::Index>& estimated,
                 const Eigen::VectorXd& before, const Eigen::MatrixXd& of_data,
                 const Eigen::MatrixXd& of_priors, ErrorBudget& budget) {
  const Eigen::Index num_parameters = budget.prior.size();
  for (std::size_t k = 0; k < estimated.size(); ++k) {
    const Eigen::Index i = estimated[k];
    const auto place = Eigen::Index(k);
    budget.prior(i) = std::sqrt(std::max(0.0, of_priors(place, place)));
    const double factor = std::sqrt(std::max(0.0, of_data(place, place)) /
                                    std::max(before(place), 1e-300));
    for (ParameterErrors* const part :
         {&budget.noise, &budget.model, &budget.outliers,
          &budget.discretization, &budget.curvature, &budget.law,
          &budget.kinematics, &budget.section}) {
      if (part->size() == num_parameters) {
        (*part)(i) *= factor;
      }
    }
  }
}

}  // namespace

void ApplyPriors(const Scene& scene, const EstimatorOptions& options,
                 Estimate& estimate) {
  constexpr double kChance = 0.01;
  if (!HasPriors(scene.materials) || !estimate.IsUsable() ||
      estimate.error_budget.prior.size() > 0) {
    return;
  }
  const FreeParameters free(scene, options);
  const std::vector<Eigen::Index>& estimated = free.All().Free();
  const Priors priors = PriorsOf(free, estimate);
  const Eigen::MatrixXd given =
      estimate.parameter_covariance(estimated, estimated);
  if (priors.places.empty() || !given.allFinite()) {
    return;
  }
  const Eigen::VectorXd units = UnitsOf(estimate, estimated);
  const Eigen::MatrixXd covariance = units.cwiseInverse().asDiagonal() * given *
                                     units.cwiseInverse().asDiagonal();
  Eigen::MatrixXd sum = covariance(priors.places, priors.places);
  sum.diagonal() += priors.variance;
  const Eigen::MatrixXd inverse = Inverse(sum);
  const Eigen::MatrixXd gain = covariance(Eigen::all, priors.places) * inverse;
  const Eigen::VectorXd change = gain * priors.distance;
  const Eigen::MatrixXd of_priors =
      gain * priors.variance.asDiagonal() * gain.transpose();
  const Eigen::MatrixXd total =
      covariance - gain * covariance(priors.places, Eigen::all);
  estimate.error_budget.prior = ParameterErrors::Constant(
      Eigen::Index(estimate.parameters.size()), Estimate::kUnknown);
  EnterBudget(estimated, covariance.diagonal(), total - of_priors, of_priors,
              estimate.error_budget);
  std::vector<ParameterEstimate> without = estimate.parameters;
  for (std::size_t k = 0; k < estimated.size(); ++k) {
    const auto place = Eigen::Index(k);
    without[estimated[k]].standard_error = std::sqrt(given(place, place));
    Move(change(place), free.VariableBounds()[k],
         estimate.parameters[estimated[k]]);
  }
  const Eigen::VectorXd units_after = UnitsOf(estimate, estimated);
  estimate.parameter_covariance(estimated, estimated) =
      units_after.asDiagonal() * total * units_after.asDiagonal();
  const double square = priors.distance.dot(inverse * priors.distance);
  const double probability =
      ChiSquaredProbability(static_cast<double>(priors.places.size()), square);
  if (probability < kChance) {
    Eigen::Index worst = 0;
    (priors.distance.array().square() / sum.diagonal().array())
        .maxCoeff(&worst);
    estimate.Add(PriorContradicted(without[estimated[priors.places[worst]]],
                                   probability));
  }
}

}  // namespace elastimate
