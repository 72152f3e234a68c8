#include "elastimate/estimators/interface/priors.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <optional>
#include <vector>

#include "elastimate/core/algebra/dense_algebra.h"
#include "elastimate/core/materials/isotropic_law.h"
#include "elastimate/core/materials/material_parameters.h"
#include "elastimate/estimators/interface/finding_sentences.h"
#include "elastimate/estimators/interface/statistics.h"

namespace elastimate {
namespace {

/// The priors of the parameters that are estimated, in the units of errors.
struct Priors {
  std::vector<Eigen::Index> places;  // Among the estimated parameters.
  Eigen::VectorXd distance;          // From the estimate, y_0 - y.
  Eigen::VectorXd variance;          // The diagonal of P.
};

std::vector<Eigen::Index> EstimatedPlaces(const Estimate& estimate) {
  std::vector<Eigen::Index> places;
  for (std::size_t i = 0; i < estimate.parameters.size(); ++i) {
    if (!estimate.parameters[i].is_known) {
      places.push_back(Eigen::Index(i));
    }
  }
  return places;
}

Priors PriorsOf(const Scene& scene, const Estimate& estimate,
                const std::vector<Eigen::Index>& estimated) {
  const MaterialParameters parameters(scene.materials,
                                      scene.mesh.section.model);
  Priors priors;
  std::vector<double> distance;
  std::vector<double> variance;
  for (std::size_t k = 0; k < estimated.size(); ++k) {
    const ParameterEstimate& of = estimate.parameters[estimated[k]];
    const std::optional<Prior>& prior = parameters.All()[estimated[k]].prior;
    if (prior) {
      priors.places.push_back(Eigen::Index(k));
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

// Between which the combination may lie: as bounds say, and a ratio between the
// ends of its range, which the linear combination does not know.
std::vector<Interval> AllowedOf(const Scene& scene,
                                const EstimatorOptions& options,
                                const Estimate& estimate,
                                const std::vector<Eigen::Index>& estimated) {
  const MaterialParameters parameters(scene.materials,
                                      scene.mesh.section.model);
  std::vector<Interval> allowed;
  for (const Eigen::Index place : estimated) {
    const ParameterEstimate& of = estimate.parameters[place];
    const bool is_isotropic =
        parameters.LawOf(parameters.All()[place].material).Name() ==
        IsotropicLaw::kName;
    Interval interval = {-std::numeric_limits<double>::infinity(),
                         std::numeric_limits<double>::infinity()};
    const auto narrow = [&interval](const Bounds& bounds) {
      if (bounds.lower) {
        interval.lower = *bounds.lower;
      }
      if (bounds.upper) {
        interval.upper = *bounds.upper;
      }
    };
    if (is_isotropic) {
      narrow(of.is_modulus ? options.youngs_modulus : options.poisson_ratio);
    }
    for (const BoundsOfParameter& given :
         scene.materials[parameters.All()[place].material].bounds) {
      if (given.name == of.name) {
        narrow(given.bounds);
      }
    }
    if (is_isotropic && !of.is_modulus) {
      interval = {std::max(interval.lower, kSmallestPoissonRatio),
                  std::min(interval.upper, kLargestPoissonRatio)};
    }
    allowed.push_back(interval);
  }
  return allowed;
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
          &budget.discretization, &budget.kinematics, &budget.section}) {
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
  const std::vector<Eigen::Index> estimated = EstimatedPlaces(estimate);
  if (!HasPriors(scene.materials) || !estimate.IsUsable() ||
      estimate.error_budget.prior.size() > 0 || estimated.empty()) {
    return;
  }
  const Priors priors = PriorsOf(scene, estimate, estimated);
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
  const std::vector<Interval> allowed =
      AllowedOf(scene, options, estimate, estimated);
  for (std::size_t k = 0; k < estimated.size(); ++k) {
    ParameterEstimate& parameter = estimate.parameters[estimated[k]];
    without[estimated[k]].standard_error =
        std::sqrt(given(Eigen::Index(k), Eigen::Index(k)));
    parameter.value = parameter.is_modulus
                          ? parameter.value * std::exp(change(k))
                          : parameter.value + change(k) * units(k);
    parameter.value =
        std::clamp(parameter.value, allowed[k].lower, allowed[k].upper);
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
