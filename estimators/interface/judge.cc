#include "elastimate/estimators/interface/judge.h"

#include <algorithm>
#include <cmath>

#include "elastimate/estimators/interface/axis_estimate.h"
#include "elastimate/estimators/interface/finding_sentences.h"
#include "elastimate/estimators/interface/kinematic_error.h"
#include "elastimate/estimators/interface/limits.h"
#include "elastimate/estimators/interface/parameter_judge.h"
#include "elastimate/estimators/interface/rules.h"
#include "elastimate/estimators/interface/statistics.h"
#include "elastimate/estimators/interface/stiffness_estimate.h"

namespace elastimate {
namespace {

void AddPoissonRatioInterval(Estimate& estimate) {
  const std::optional<double> error = estimate.PoissonRatioStandardError();
  if (estimate.poisson_ratio_interval || !error) {
    return;
  }
  const double nu = estimate.elasticity.poisson_ratio;
  const double one_sided =
      OneSidedErrors(estimate.noise_degrees_of_freedom) * *error;
  const double two_sided =
      TwoSidedErrors(estimate.noise_degrees_of_freedom) * *error;
  if (nu + one_sided > 0.5) {
    estimate.poisson_ratio_interval = {nu - one_sided, 0.5};
  } else if (nu - one_sided < -1) {
    estimate.poisson_ratio_interval = {-1, nu + one_sided};
  } else {
    estimate.poisson_ratio_interval = {std::max(-1.0, nu - two_sided),
                                       std::min(0.5, nu + two_sided)};
  }
}

void RemoveErrorBarsOfNone(Estimate& estimate) {
  if (!estimate.IsUsable()) {
    std::transform(estimate.findings.begin(), estimate.findings.end(),
                   estimate.findings.begin(), WithoutErrorBars);
  }
}

// What the mesh leaves open.
void JudgeMeshError(const Scene& scene, Estimate& estimate) {
  if (!estimate.IsUsable()) {
    return;
  }
  const bool is_known =
      estimate.error_budget.discretization.array().isFinite().any();
  if (scene.origin == Origin::kMeasured && !is_known) {
    estimate.Add(MeshErrorUnknown());
  } else if (IsDiscretizationErrorNotable(estimate) &&
             !estimate.Has(FindingCode::kSupportsEndWithinElements)) {
    estimate.Add(DiscretizationErrorFinding(estimate));
  }
}

// What a method without a finite element solution does not know, the data may.
void FailUndetermined(Finding finding, Estimate& estimate) {
  if (estimate.Has(FindingCode::kSupportsEndWithinElements)) {
    finding.advice = "give the supports as boxes";
  } else if (IsDiscretizationErrorNotable(estimate)) {
    finding.advice = "use a finer mesh";
  } else if (!estimate.displacement_residual) {
    finding.advice += ", or use reduced-fe";
  }
  estimate.Fail(finding);
}

// Where nu has no standard error.
bool IsIntervalTooWide(const Estimate& estimate) {
  if (!estimate.poisson_ratio_interval ||
      estimate.PoissonRatioStandardError()) {
    return false;
  }
  const auto& [lower, upper] = *estimate.poisson_ratio_interval;
  const double nu = estimate.elasticity.poisson_ratio;
  return std::max(nu - lower, upper - nu) >
         kLimits.LargestPoissonRatioDistance();
}

void JudgeResult(const EstimatorOptions& options, Estimate& estimate) {
  if (!estimate.IsUsable()) {
    return;
  }
  const IsotropicElasticity& elasticity = estimate.elasticity;
  // Infinite where nothing limits E; not a number, which exceeds nothing, where
  // E is not free.
  const double youngs_modulus_error = std::sqrt(estimate.covariance(0, 0));
  if (!std::isfinite(elasticity.youngs_modulus) ||
      !std::isfinite(elasticity.poisson_ratio)) {
    estimate.Fail(NotFinite());
  } else if (!elasticity.IsPhysical()) {
    estimate.Fail(Unphysical(elasticity));
  } else if (!options.known_poisson_ratio &&
             estimate.PoissonRatioStandardError().value_or(0) >
                 kLimits.largest_poisson_ratio_error) {
    FailUndetermined(PoissonRatioUndetermined(estimate), estimate);
  } else if (!options.known_poisson_ratio && IsIntervalTooWide(estimate)) {
    FailUndetermined(PoissonRatioBetween(*estimate.poisson_ratio_interval),
                     estimate);
  } else if (youngs_modulus_error >
             kLimits.largest_youngs_modulus_error * elasticity.youngs_modulus) {
    FailUndetermined(YoungsModulusUndetermined(elasticity.youngs_modulus,
                                               youngs_modulus_error),
                     estimate);
  }
}

}  // namespace

bool IsDiscretizationErrorNotable(const Estimate& estimate) {
  return AreNotable(estimate.error_budget.discretization, estimate);
}

void Judge(const Evidence& evidence, const EstimatorOptions& options,
           Estimate& estimate) {
  std::optional<Finding> error;
  for (const Rule rule : Rules()) {
    const std::optional<Finding> finding = rule(evidence, options, estimate);
    if (!finding) {
      continue;
    }
    if (finding->severity != Severity::kError) {
      estimate.Add(*finding);
    } else if (!error) {
      error = finding;
    }
  }
  if (error) {
    estimate.Fail(*error);
    return;
  }
  estimate.Accept();
  if (evidence.active.Any()) {
    estimate.why_no_standard_error = "a parameter on a bound has none";
  }
}

void FinishEstimate(std::string_view estimator, const Scene& scene,
                    const EstimatorOptions& options,
                    const std::vector<Finding>& findings, Estimate& estimate) {
  estimate.estimator = estimator;
  if (estimate.element_order == 0) {
    estimate.element_order = scene.mesh.Order();
  }
  // An estimator that ran another has its findings already.
  for (auto finding = findings.rbegin(); finding != findings.rend();
       ++finding) {
    if (!estimate.Has(finding->code)) {
      estimate.findings.insert(estimate.findings.begin(), *finding);
    }
  }
  JudgeKinematics(scene, options, estimate);
  JudgeThickness(scene, estimate);
  if (!estimate.parameters.empty() ||
      !IsOneIsotropicMaterial(scene.materials)) {
    estimate.stiffnesses = StiffnessesOf(scene, estimate);
    estimate.axes = AxesOf(scene, estimate);
    JudgeParameters(estimate);
    JudgeMeshError(scene, estimate);
    RemoveErrorBarsOfNone(estimate);
    EnterElasticity(estimate);
    JudgeSignOfPoissonRatio(estimate);
    return;
  }
  estimate.error_budget.discretization = Eigen::Vector2d(
      estimate.discretization_error.value_or(Estimate::kUnknown),
      estimate.poisson_ratio_discretization_error.value_or(Estimate::kUnknown));
  JudgeResult(options, estimate);
  if (estimate.IsUsable()) {
    AddPoissonRatioInterval(estimate);
  }
  DescribeOneIsotropicMaterial(scene, options, estimate);
  JudgeMeshError(scene, estimate);
  RemoveErrorBarsOfNone(estimate);
  JudgeSignOfPoissonRatio(estimate);
}

}  // namespace elastimate
