#include "elastimate/estimators/interface/judge.h"

#include <algorithm>
#include <cmath>
#include <sstream>

#include "elastimate/estimators/interface/statistics.h"

namespace elastimate {
namespace {

std::string Text(double value) {
  std::ostringstream text;
  text << value;
  return text.str();
}

// 95 % of a normal distribution, two-sided and one-sided.
void AddPoissonRatioInterval(Estimate& estimate) {
  constexpr double kTwoSided = 1.960;
  constexpr double kOneSided = 1.645;
  const std::optional<double> error = estimate.PoissonRatioStandardError();
  if (estimate.poisson_ratio_interval || !error) {
    return;
  }
  const double nu = estimate.elasticity.poisson_ratio;
  if (nu + kOneSided * *error > 0.5) {
    estimate.poisson_ratio_interval = {nu - kOneSided * *error, 0.5};
  } else if (nu - kOneSided * *error < -1) {
    estimate.poisson_ratio_interval = {-1, nu + kOneSided * *error};
  } else {
    estimate.poisson_ratio_interval = {std::max(-1.0, nu - kTwoSided * *error),
                                       std::min(0.5, nu + kTwoSided * *error)};
  }
}

constexpr char kLockingWarning[] =
    "linear tetrahedra are too stiff from nu = 0.45 on (they lock), which "
    "biases E and nu and makes their standard errors too small, unless the "
    "displacements come from the same mesh; quadratic ones (order 2) hardly do";

void WarnOnce(const std::string& warning, Estimate& estimate) {
  if (std::find(estimate.warnings.begin(), estimate.warnings.end(), warning) ==
      estimate.warnings.end()) {
    estimate.warnings.push_back(warning);
  }
}

void WarnOfElements(Estimate& estimate) {
  constexpr double kLocking = 0.45;
  if (estimate.element_order == 1 &&
      estimate.elasticity.poisson_ratio >= kLocking) {
    WarnOnce(kLockingWarning, estimate);
  }
  if (IsDiscretizationErrorNotable(estimate)) {
    // Beyond this the estimate says no more than that E is far too low.
    constexpr double kHopeless = 0.5;
    std::string effect = "so that E may be many times larger, ";
    if (*estimate.discretization_error < kHopeless) {
      effect = "which makes E wrong by about as much";
      if (estimate.poisson_ratio_discretization_error) {
        effect += " and nu by up to " +
                  TwoDigits(*estimate.poisson_ratio_discretization_error);
      }
      effect += ", on top of the standard errors, ";
    }
    WarnOnce(DescribeDiscretizationError(estimate) + ", " + effect +
                 "unless the displacements were computed with these very "
                 "elements: refine the mesh" +
                 (estimate.element_order == 1
                      ? ", or use quadratic elements (order 2)"
                      : ""),
             estimate);
  }
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
  // What a method without a finite element solution does not know, the data
  // may.
  if (estimate.status == Status::kNotIdentifiable &&
      !estimate.displacement_residual) {
    estimate.message += "; reduced-fe takes more from the same data";
  }
}

}  // namespace

bool IsDiscretizationErrorNotable(const Estimate& estimate) {
  constexpr double kNotable = 0.01;
  constexpr double kStandardErrors = 0.5;
  const double youngs_modulus =
      estimate.YoungsModulusStandardError().value_or(0) /
      estimate.elasticity.youngs_modulus;
  const double poisson_ratio = estimate.PoissonRatioStandardError().value_or(0);
  return estimate.discretization_error.value_or(0) >
             std::max(kNotable, kStandardErrors * youngs_modulus) ||
         estimate.poisson_ratio_discretization_error.value_or(0) >
             std::max(kNotable, kStandardErrors * poisson_ratio);
}

std::string DescribeDiscretizationError(const Estimate& estimate) {
  return "the elements miss about " +
         TwoDigits(100 * *estimate.discretization_error) +
         " % of the strain energy";
}

void AcceptElements(Estimate& estimate) {
  const auto is_told = [what = DescribeDiscretizationError(estimate)](
                           const std::string& warning) {
    return warning.find(what) == 0;
  };
  estimate.warnings.erase(std::remove_if(estimate.warnings.begin(),
                                         estimate.warnings.end(), is_told),
                          estimate.warnings.end());
  estimate.discretization_error = 0;
  estimate.poisson_ratio_discretization_error = 0;
}

bool IsWarningOfLocking(const std::string& warning) {
  return warning == kLockingWarning;
}

void NoteSolver(const std::string& notice, Estimate& estimate) {
  if (!notice.empty()) {
    WarnOnce(notice, estimate);
  }
}

void FinishEstimate(const Estimator& estimator, const Scene& scene,
                    const EstimatorOptions& options,
                    const std::vector<std::string>& warnings,
                    Estimate& estimate) {
  estimate.estimator = estimator.Name();
  if (estimate.element_order == 0) {
    estimate.element_order = scene.mesh.Order();
  }
  // An estimator that ran another has its warnings already.
  for (auto warning = warnings.rbegin(); warning != warnings.rend();
       ++warning) {
    if (std::find(estimate.warnings.begin(), estimate.warnings.end(),
                  *warning) == estimate.warnings.end()) {
      estimate.warnings.insert(estimate.warnings.begin(), *warning);
    }
  }
  CheckResult(options, estimate);
  if (estimate.IsUsable()) {
    AddPoissonRatioInterval(estimate);
    WarnOfElements(estimate);
  }
}

}  // namespace elastimate
