#include "elastimate/estimators/interface/judge.h"

#include <algorithm>
#include <cmath>

#include "elastimate/core/text/numbers.h"
#include "elastimate/estimators/interface/axis_estimate.h"
#include "elastimate/estimators/interface/finding_sentences.h"
#include "elastimate/estimators/interface/kinematic_error.h"
#include "elastimate/estimators/interface/limits.h"
#include "elastimate/estimators/interface/parameter_judge.h"
#include "elastimate/estimators/interface/priors.h"
#include "elastimate/estimators/interface/rules.h"
#include "elastimate/estimators/interface/statistics.h"
#include "elastimate/estimators/interface/stiffness_estimate.h"

namespace elastimate {
namespace {

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
    estimate.Add(estimate.map && scene.mesh.Order() == 2
                     ? MeshErrorOfMapUnknown()
                     : MeshErrorUnknown());
  } else if (AreNotable(estimate.error_budget.discretization, estimate) &&
             !estimate.Has(FindingCode::kSupportsEndWithinElements)) {
    estimate.Add(DiscretizationErrorFinding(estimate));
  }
}

// Fails an estimate that claims to be usable without parameters of the
// materials or the covariance of these.
void RequireParameters(Estimate& estimate) {
  const auto size = Eigen::Index(estimate.parameters.size());
  if (!estimate.IsUsable()) {
    return;
  }
  if (size == 0) {
    estimate.Fail(
        ErrorsMissing(estimate.estimator, "parameters of the materials"));
  } else if (estimate.parameter_covariance.rows() != size ||
             estimate.parameter_covariance.cols() != size) {
    estimate.Fail(ErrorsMissing(
        estimate.estimator,
        "a covariance of its " + Counted(std::size_t(size), "parameter")));
  }
}

// Fails an estimate that claims to be usable without the variance of a
// parameter or a reason for that: nobody could tell how far to trust the value.
void RequireErrors(Estimate& estimate) {
  for (std::size_t i = 0; i < estimate.parameters.size(); ++i) {
    const ParameterEstimate& parameter = estimate.parameters[i];
    const auto place = Eigen::Index(i);
    if (estimate.IsUsable() && estimate.why_no_standard_error.empty() &&
        !parameter.is_known &&
        std::isnan(estimate.parameter_covariance(place, place))) {
      estimate.Fail(ErrorsMissing(estimate.estimator,
                                  "a standard error of " + parameter.Label()));
    }
  }
}

}  // namespace

void Judge(const Evidence& evidence, const EstimatorOptions& options,
           Estimate& estimate) {
  estimate.Accept();
  std::optional<Finding> error;
  for (const Finding& finding : ApplyRules(evidence, options, estimate)) {
    if (finding.severity != Severity::kError) {
      estimate.Add(finding);
    } else if (!error) {
      error = finding;
    }
  }
  if (error) {
    estimate.Fail(*error);
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
  if (estimate.parameters.empty() && IsOneIsotropicMaterial(scene.materials)) {
    EnterParametersOfElasticity(scene, options, estimate);
    RequireErrors(estimate);
  }
  RequireParameters(estimate);
  JudgeKinematics(scene, estimate);
  JudgeInversion(scene, estimate);
  JudgeRigidFaces(scene, estimate);
  JudgeThickness(scene, estimate);
  ApplyPriors(scene, options, estimate);
  estimate.stiffnesses = StiffnessesOf(scene, estimate);
  estimate.axes = AxesOf(scene, estimate);
  JudgeParameters(estimate);
  JudgeMeshError(scene, estimate);
  RemoveErrorBarsOfNone(estimate);
  EnterElasticity(estimate);
  JudgeSignOfPoissonRatio(estimate);
}

}  // namespace elastimate
