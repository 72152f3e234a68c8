#include "elastimate/estimators/interface/judge.h"

#include <algorithm>
#include <cmath>

#include "elastimate/estimators/interface/axis_estimate.h"
#include "elastimate/estimators/interface/finding_sentences.h"
#include "elastimate/estimators/interface/kinematic_error.h"
#include "elastimate/estimators/interface/limits.h"
#include "elastimate/estimators/interface/missing_errors.h"
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
    estimate.Add(MeshErrorUnknown());
  } else if (IsDiscretizationErrorNotable(estimate) &&
             !estimate.Has(FindingCode::kSupportsEndWithinElements)) {
    estimate.Add(DiscretizationErrorFinding(estimate));
  }
}

}  // namespace

bool IsDiscretizationErrorNotable(const Estimate& estimate) {
  return AreNotable(estimate.error_budget.discretization, estimate);
}

void Judge(const Evidence& evidence, const EstimatorOptions& options,
           Estimate& estimate) {
  estimate.Accept();
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
  if (estimate.parameters.empty() && IsOneIsotropicMaterial(scene.materials)) {
    EnterParametersOfElasticity(scene, options, estimate);
    FailWithoutErrors(estimate);
  }
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
