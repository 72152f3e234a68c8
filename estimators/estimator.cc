#include "elastimate/estimators/estimator.h"

#include <chrono>
#include <cmath>
#include <sstream>
#include <stdexcept>

#include "elastimate/core/degrees_of_freedom.h"
#include "elastimate/core/loads.h"
#include "elastimate/estimators/statistics.h"

namespace elastimate {
namespace {

std::string Text(double value) {
  std::ostringstream text;
  text << value;
  return text.str();
}

std::string WhyInvalidBounds(const Bounds& bounds, const std::string& name,
                             double smallest, double largest,
                             const std::string& range) {
  for (const auto& bound : {bounds.lower, bounds.upper}) {
    if (bound && !(*bound >= smallest && *bound <= largest)) {
      return "a bound on " + name + " is " + Text(*bound) + "; it must be " +
             range;
    }
  }
  if (bounds.lower && bounds.upper && !(*bounds.lower < *bounds.upper)) {
    return "the bounds on " + name + " are crossed: the lower is " +
           Text(*bounds.lower) + ", the upper " + Text(*bounds.upper);
  }
  return "";
}

// What one load case measured at the free degrees of freedom.
struct MeasurementSummary {
  bool any_observed = false;
  bool any_displacement = false;
  bool any_force = false;
  double free_square_sum = 0;
  double held_deviation_square_sum = 0;
};

MeasurementSummary Summarize(const Scene& scene, const LoadCase& load_case) {
  MeasurementSummary summary;
  const Eigen::Matrix3Xd force = AssembleLoads(scene.mesh, load_case.loads);
  for (Eigen::Index node = 0; node < scene.mesh.NumNodes(); ++node) {
    for (int i = 0; i < 3; ++i) {
      const bool held = scene.supports.held(i, node);
      summary.any_force |= !held && force(i, node) != 0;
      if (!IsObserved(load_case, i, node)) {
        continue;
      }
      const double q = load_case.displacement(i, node);
      if (held) {
        const double deviation = q - scene.supports.displacement(i, node);
        summary.held_deviation_square_sum += deviation * deviation;
      } else {
        summary.any_observed = true;
        summary.any_displacement |= q != 0;
        summary.free_square_sum += q * q;
      }
    }
  }
  return summary;
}

// Checks what every estimator needs; returns warnings.
std::vector<std::string> CheckMeasurements(const Scene& scene) {
  std::vector<std::string> warnings;
  bool any_force = false;
  std::size_t num_with_noise_sd = 0;
  for (std::size_t k = 0; k < scene.load_cases.size(); ++k) {
    const LoadCase& load_case = scene.load_cases[k];
    const std::string name = "load case " + std::to_string(k + 1);
    if (load_case.displacement.size() == 0) {
      throw std::invalid_argument(
          name + " has no measured displacements; an estimate needs them");
    }
    const MeasurementSummary summary = Summarize(scene, load_case);
    if (!summary.any_observed) {
      throw std::invalid_argument(
          "no free component of the displacement was measured in " + name +
          "; measure some, or free what was measured");
    }
    if (!summary.any_displacement) {
      throw std::invalid_argument(
          "the measured displacement of " + name +
          " is zero at every free node; nothing moved, so nothing can be "
          "estimated");
    }
    any_force |= summary.any_force;
    num_with_noise_sd += load_case.noise_sd ? 1 : 0;
    // Measurement noise on held nodes is no contradiction; a motion is.
    if (summary.held_deviation_square_sum > 0.01 * summary.free_square_sum) {
      warnings.push_back(
          "the measured displacement of held nodes in " + name +
          " differs from the displacement they are held at, which is used; "
          "check the supports");
    }
  }
  if (!any_force) {
    throw std::invalid_argument(
        "the loads are zero on every free degree of freedom; without a known "
        "force Young's modulus cannot be estimated");
  }
  if (num_with_noise_sd != 0 && num_with_noise_sd != scene.load_cases.size()) {
    throw std::invalid_argument(
        "the noise standard deviation is given for some load cases only; give "
        "it for all or for none");
  }
  return warnings;
}

void CheckResult(const EstimatorOptions& options, Estimate& estimate) {
  if (estimate.status != Status::kOk) {
    return;
  }
  const IsotropicElasticity& elasticity = estimate.elasticity;
  if (!std::isfinite(elasticity.youngs_modulus) ||
      !std::isfinite(elasticity.poisson_ratio)) {
    estimate.status = Status::kNumericalFailure;
    estimate.message = "the result is not finite";
  } else if (!elasticity.IsPhysical()) {
    estimate.status = Status::kUnphysical;
    estimate.message = "E = " + Text(elasticity.youngs_modulus) +
                       ", nu = " + Text(elasticity.poisson_ratio) +
                       " is not physical (E > 0, -1 < nu < 0.5)";
  } else if (!options.known_poisson_ratio &&
             estimate.PoissonRatioStandardError().value_or(0) >
                 kLargestPoissonRatioError) {
    estimate.status = Status::kNotIdentifiable;
    estimate.message = DescribeWhatIsDetermined(estimate);
  } else if (estimate.YoungsModulusStandardError().value_or(0) >
             kLargestYoungsModulusError * elasticity.youngs_modulus) {
    estimate.status = Status::kNotIdentifiable;
    estimate.message =
        "the data do not determine Young's modulus: E = " +
        Text(elasticity.youngs_modulus) + " has a standard error of " +
        Text(*estimate.YoungsModulusStandardError()) +
        (estimate.warnings.empty()
             ? "; measure larger displacements, or more load cases"
             : "; see the warnings");
  }
}

}  // namespace

std::string EstimatorOptions::WhyInvalid() const {
  if (known_poisson_ratio &&
      !(*known_poisson_ratio > -1 && *known_poisson_ratio < 0.5)) {
    return "the known Poisson's ratio is " + Text(*known_poisson_ratio) +
           "; it must be above -1 and below 0.5";
  }
  if (known_poisson_ratio && poisson_ratio.AreGiven()) {
    return "Poisson's ratio is given as known and has bounds; give one or the "
           "other";
  }
  std::string why = WhyInvalidBounds(poisson_ratio, "Poisson's ratio", -1, 0.5,
                                     "between -1 and 0.5");
  if (why.empty() &&
      (poisson_ratio.lower.value_or(-1) >= kLargestPoissonRatio ||
       poisson_ratio.upper.value_or(0.5) <= kSmallestPoissonRatio)) {
    why = "the bounds on Poisson's ratio leave nothing between " +
          Text(kSmallestPoissonRatio) + " and " + Text(kLargestPoissonRatio);
  }
  if (why.empty()) {
    why = WhyInvalidBounds(
        youngs_modulus, "Young's modulus", std::numeric_limits<double>::min(),
        std::numeric_limits<double>::max(), "positive and finite");
  }
  if (why.empty() && max_iterations < 1) {
    why = "the largest number of iterations is " +
          std::to_string(max_iterations) + "; it must be at least 1";
  }
  if (why.empty() && virtual_field_degree &&
      !(*virtual_field_degree >= 1 && *virtual_field_degree <= 3)) {
    why = "the degree of the virtual fields is " +
          std::to_string(*virtual_field_degree) + "; it must be 1, 2 or 3";
  }
  return why;
}

Estimate Estimator::Run(const Scene& scene,
                        const EstimatorOptions& options) const {
  const auto start = std::chrono::steady_clock::now();
  ValidateScene(scene);
  const std::string why_invalid = options.WhyInvalid();
  if (!why_invalid.empty()) {
    throw std::invalid_argument(why_invalid);
  }
  const std::vector<std::string> warnings = CheckMeasurements(scene);
  const std::string why_unsupported = WhyUnsupported(scene, options);
  if (!why_unsupported.empty()) {
    throw std::invalid_argument(std::string(Name()) + ": " + why_unsupported);
  }
  Estimate estimate = DoRun(scene, options);
  estimate.estimator = Name();
  estimate.warnings.insert(estimate.warnings.begin(), warnings.begin(),
                           warnings.end());
  CheckResult(options, estimate);
  estimate.seconds =
      std::chrono::duration<double>(std::chrono::steady_clock::now() - start)
          .count();
  return estimate;
}

}  // namespace elastimate
