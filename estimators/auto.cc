#include "elastimate/estimators/auto.h"

#include <memory>

#include "elastimate/core/scene/quadratic_scene.h"
#include "elastimate/core/scene/unknown_motion.h"
#include "elastimate/core/text/numbers.h"
#include "elastimate/estimators/displacement_fit/iterative_fe.h"
#include "elastimate/estimators/displacement_fit/reduced_fe.h"
#include "elastimate/estimators/element_order.h"
#include "elastimate/estimators/force_balance/closed_form.h"
#include "elastimate/estimators/force_balance/virtual_fields.h"
#include "elastimate/estimators/interface/finding_sentences.h"
#include "elastimate/estimators/interface/judge.h"
#include "elastimate/estimators/interface/limits.h"
#include "elastimate/estimators/interface/parameter_judge.h"
#include "elastimate/estimators/interface/stopwatch.h"
#include "elastimate/estimators/material_fit/material_fit.h"
#include "elastimate/estimators/statistics/model_mismatch.h"

namespace elastimate {
namespace {

// Quadratic elements take some 45 KiB each in the factor.
constexpr Eigen::Index kMostQuadraticElements = 100000;

EstimatorOptions WithoutDegree(EstimatorOptions options) {
  options.virtual_field_degree.reset();
  return options;
}

// Why the standard errors of an estimate are too large; empty when they are
// not.
std::string WhyNotWithinTolerance(const EstimatorOptions& options,
                                  const Estimate& estimate) {
  const std::optional<double> youngs = estimate.YoungsModulusStandardError();
  const std::optional<double> poisson = estimate.PoissonRatioStandardError();
  if (!estimate.active_bounds.empty()) {
    return "a parameter lies on a bound";
  }
  if (!youngs || (!poisson && !options.known_poisson_ratio)) {
    return "no standard error is known";
  }
  const double relative = *youngs / estimate.elasticity.youngs_modulus;
  if (relative > kLimits.notable_youngs_modulus_error) {
    return "the standard error of E is " + Percent(relative);
  }
  if (poisson.value_or(0) > kLimits.notable_poisson_ratio_error) {
    return "the standard error of nu is " + TwoDigits(*poisson);
  }
  return "";
}

// The same of several materials.
std::string WhyParametersNotWithinTolerance(const Estimate& estimate) {
  for (const ParameterEstimate& parameter : estimate.parameters) {
    const double error =
        parameter.standard_error.value_or(0) / parameter.ErrorUnit();
    const double tolerance = parameter.IsStiffness()
                                 ? kLimits.notable_youngs_modulus_error
                                 : kLimits.notable_poisson_ratio_error;
    if (error > tolerance) {
      return "the standard error of " + parameter.Label() + " is " +
             (parameter.IsStiffness() ? Percent(error) : TwoDigits(error));
    }
  }
  return "";
}

// Without advice, which the next rung takes.
std::string WhyNotUsable(const Estimate& estimate) {
  for (const Finding& finding : estimate.findings) {
    if (finding.severity == Severity::kError) {
      return "not usable: " + finding.text;
    }
  }
  return "not usable: " + estimate.message;
}

// No other estimator takes displacements that are too large for this one.
bool IsRefusedForItsSize(const Estimate& estimate) {
  return !estimate.IsUsable() && !estimate.findings.empty() &&
         estimate.findings[0].code == FindingCode::kLargeDeformation;
}

// For a rung whose errors may come from its method; empty when it will do.
std::string WhyNotEnough(const Scene& scene, const EstimatorOptions& options,
                         const Estimate& estimate) {
  if (IsRefusedForItsSize(estimate)) {
    return "";
  }
  if (!estimate.IsUsable()) {
    return WhyNotUsable(estimate);
  }
  for (const Finding& finding : estimate.findings) {
    if (finding.severity == Severity::kWarning &&
        finding.code != FindingCode::kLocking &&
        finding.code != FindingCode::kLargeDeformation &&
        finding.code != FindingCode::kNegativePoissonRatio &&
        finding.code != FindingCode::kMarginNotGiven) {
      return "it warns: " + finding.text;
    }
  }
  return IsOneIsotropicMaterial(scene.materials)
             ? WhyNotWithinTolerance(options, estimate)
             : WhyParametersNotWithinTolerance(estimate);
}

// The same of closed-form, which does not know what elements miss: only loads
// that balance in these elements, but for rounding, exclude it.
std::string WhyClosedFormIsNotEnough(const Scene& scene,
                                     const EstimatorOptions& options,
                                     const Estimate& estimate) {
  const std::string why_not = WhyNotEnough(scene, options, estimate);
  return why_not.empty() && !(estimate.force_residual.value_or(0) <=
                              kLimits.exact_residual)
             ? "what its elements miss is not known"
             : why_not;
}

// Whether virtual-fields contradicts the model of the fit.
bool IsMismatch(const Estimate& estimate) {
  return estimate.model_mismatch && estimate.model_mismatch->matters &&
         estimate.model_mismatch->p_value < kLimits.mismatch_significance;
}

// Of a fit by virtual-fields, where that ran.
void CheckAgainst(const std::optional<Estimate>& virtual_fields,
                  Estimate& fit) {
  if (virtual_fields) {
    fit.model_mismatch = FindModelMismatch(*virtual_fields, fit);
  }
}

void NoteMismatch(Estimate& estimate) {
  if (estimate.IsUsable() && IsMismatch(estimate)) {
    estimate.Add(ModelMismatchFinding(*estimate.model_mismatch));
  }
}

// For a fit at the statistical limit; empty when its elements will do.
std::string WhyTheModelIsNotEnough(const EstimatorOptions& options,
                                   const Estimate& estimate) {
  if (!estimate.IsUsable()) {
    return WhyNotUsable(estimate);
  }
  if (IsMismatch(estimate)) {
    return ModelMismatchFinding(*estimate.model_mismatch).text;
  }
  if (IsDiscretizationErrorNotable(estimate)) {
    return DescribeDiscretizationError(estimate);
  }
  if (estimate.is_model_in_doubt) {
    const std::string why = WhyNotWithinTolerance(options, estimate);
    if (!why.empty()) {
      return "the residual is no noise, and " + why;
    }
  }
  return "";
}

// Climbs, and keeps the books.
class Ladder {
 public:
  // Runs an estimator as the next rung, or what it prepared; false when it does
  // not support the scene.
  bool Climb(const Estimator& estimator, const Scene& scene,
             const EstimatorOptions& options,
             Preparation* preparation = nullptr) {
    const std::string why_not = estimator.WhyUnsupported(scene, options);
    Rung rung;
    rung.estimator = estimator.Name();
    rung.element_order = scene.mesh.Order();
    if (!why_not.empty()) {
      rung.decision = "passed over: " + why_not;
      rungs_.push_back(rung);
      return false;
    }
    if (preparation == nullptr) {
      estimate_ = estimator.Run(scene, options);
    } else {
      Stopwatch stopwatch;
      estimate_ = preparation->Run(scene);
      FinishEstimate(estimator.Name(), scene, options, {}, estimate_);
      estimate_.seconds = stopwatch.Lap();
    }
    work_ = work_ + estimate_.work;
    for (const StageTime& stage : estimate_.stages) {
      stages_.push_back({std::string(estimator.Name()) +
                             (rung.element_order == 2 ? " (order 2): " : ": ") +
                             stage.stage,
                         stage.seconds});
    }
    rung.status = estimate_.status;
    rung.elasticity = estimate_.elasticity;
    rung.work = estimate_.work;
    rung.seconds = estimate_.seconds;
    rungs_.push_back(rung);
    return true;
  }

  void Decide(const std::string& decision) {
    rungs_.back().decision = decision;
  }
  /// Of the last rung that ran.
  Estimate& Last() { return estimate_; }
  void Return(const Estimate& estimate) { estimate_ = estimate; }

  Estimate Finish() {
    estimate_.work = work_;
    estimate_.stages = stages_;
    estimate_.rungs = rungs_;
    return estimate_;
  }

 private:
  Estimate estimate_;
  Work work_;
  std::vector<StageTime> stages_;
  std::vector<Rung> rungs_;
};

// Decides about the last rung; whether it is the last one.
bool StopsHere(const std::string& why_not_enough, Ladder& ladder) {
  ladder.Decide(why_not_enough.empty() ? "stopped: within tolerance"
                                       : "went on: " + why_not_enough);
  return why_not_enough.empty();
}

// Ends at linear elements, after quadratic ones were tried.
void KeepLinear(const std::string& why, Estimate linear, Ladder& ladder) {
  ladder.Decide("stopped: " + why);
  for (Finding& finding : linear.findings) {
    finding = WithoutOrderAdvice(finding);
    if (finding.severity == Severity::kError) {
      linear.message = Sentence(finding);
    }
  }
  ladder.Return(linear);
}

// Of the rungs of both orders, when the lower one was not enough.
void ChooseOrder(const Scene& scene, const EstimatorOptions& options,
                 const Estimate& linear, Ladder& ladder) {
  Estimate& quadratic = ladder.Last();
  if (quadratic.status == Status::kNumericalFailure) {
    KeepLinear("it failed, and linear elements are kept: " + quadratic.message,
               linear, ladder);
    return;
  }
  const OrderComparison compared(scene, options, linear, quadratic);
  const bool is_coarse = IsDiscretizationErrorNotable(linear) ||
                         linear.Has(FindingCode::kLocking) ||
                         !linear.IsUsable();
  const bool is_too_coarse = linear.Has(FindingCode::kElementsTooCoarse);
  if (!linear.IsUsable() && !is_too_coarse && quadratic.IsUsable() &&
      !compared.IsQuadraticFarBetter()) {
    KeepLinear(
        "it does not explain the displacements far better, so that "
        "what linear elements were refused for stands",
        linear, ladder);
    return;
  }
  if (is_coarse && compared.IsLinearFarBetter()) {
    KeepLinear(
        "linear elements, which are kept, explain the displacements "
        "far better",
        linear, ladder);
    return;
  }
  if (linear.IsUsable() && compared.IsLinearLikely()) {
    KeepLinear(
        "linear elements, which are kept, are likelier to have made "
        "the displacements",
        linear, ladder);
    return;
  }
  if (!is_coarse && !compared.IsQuadraticFarBetter()) {
    KeepLinear("the residual is not that of linear elements, which are kept",
               linear, ladder);
    return;
  }
  ladder.Decide("stopped: there is no rung above");
  if (quadratic.IsUsable() && (linear.IsUsable() || is_too_coarse)) {
    compared.HoldLinear(quadratic);
    if (!compared.IsQuadraticLikely()) {
      quadratic.Add(LinearElementsFitAsWell(compared.ByLinear()));
    }
  }
}

// Goes on to quadratic elements where linear ones are too coarse.
void ClimbToQuadraticElements(const Scene& scene,
                              const EstimatorOptions& options, Ladder& ladder) {
  const Estimate& linear = ladder.Last();
  const bool are_too_coarse =
      linear.Has(FindingCode::kElementsTooCoarse) ||
      (!linear.IsUsable() && (linear.Has(FindingCode::kPoissonRatioAtLimit) ||
                              AreUndeterminedByElements(linear)));
  if (!are_too_coarse || !HasQuadraticKind(scene.mesh.kind) ||
      scene.mesh.NumElements() > kMostQuadraticElements ||
      !ReducedFe().WhyUnsupported(scene, options).empty()) {
    return;
  }
  ladder.Decide("went on: " + WhyNotUsable(linear));
  const Scene quadratic = QuadraticScene(scene);
  ladder.Climb(ReducedFe(), quadratic, options);
  if (ladder.Last().Has(FindingCode::kFitNotCertified)) {
    ladder.Decide("went on: " + WhyNotUsable(ladder.Last()));
    ladder.Climb(IterativeFe(), quadratic, options);
  }
  ladder.Decide("stopped: there is no rung above");
}

// Of several materials: only a fit sees that regions are wrong, and none of
// those of the force balance is a start that it needs.
void ClimbOverMaterials(const Scene& scene, const EstimatorOptions& options,
                        Preparation* fit, Ladder& ladder) {
  const EstimatorOptions without_degree = WithoutDegree(options);
  if (ReducedFe().WhyUnsupported(scene, without_degree).empty()) {
    ladder.Climb(ReducedFe(), scene, without_degree);
    const Estimate& reduced = ladder.Last();
    if (!reduced.Has(FindingCode::kFitNotCertified) &&
        reduced.status != Status::kNumericalFailure) {
      ladder.Decide(reduced.IsUsable()
                        ? "stopped: at the statistical limit of the data"
                        : "stopped: there is no rung above");
      ClimbToQuadraticElements(scene, without_degree, ladder);
      return;
    }
    ladder.Decide("went on: " + WhyNotUsable(reduced));
  }
  if (!ladder.Climb(IterativeFe(), scene, without_degree, fit) &&
      !ladder.Climb(VirtualFields(), scene, options)) {
    return;
  }
  ladder.Decide("stopped: there is no rung above");
  ClimbToQuadraticElements(scene, without_degree, ladder);
}

// Of unknown motions, whose only rung is iterative-fe.
class PreparedUnknownMotion : public Preparation {
 public:
  explicit PreparedUnknownMotion(const EstimatorOptions& options)
      : options_(WithoutDegree(options)),
        fit_(PrepareMaterialFit(options_, Descent::kFull)) {}

  Estimate Run(const Scene& scene) override {
    Ladder ladder;
    ladder.Climb(ClosedForm(), scene, options_);
    ClimbOverMaterials(scene, options_, fit_.get(), ladder);
    return ladder.Finish();
  }
  bool TakesOtherLoadCases() const override { return true; }

 private:
  EstimatorOptions options_;
  std::unique_ptr<Preparation> fit_;
};

}  // namespace

std::string_view Auto::Name() const { return "auto"; }

std::string_view Auto::Description() const {
  return "climbs from closed-form over virtual-fields to reduced-fe and "
         "quadratic elements, as far as the scene needs (of unknown motions: "
         "to iterative-fe)";
}

Capabilities Auto::WhatItTakes() const {
  Capabilities capabilities;
  capabilities.takes_bounds = true;
  capabilities.takes_losses = true;
  capabilities.takes_degree = true;
  capabilities.takes_materials = true;
  capabilities.takes_free_axes = true;
  capabilities.takes_unknown_motion = true;
  capabilities.takes_supports_of_cases = true;
  return capabilities;
}

std::string Auto::WhyUnsupported(const Scene& scene,
                                 const EstimatorOptions& options) const {
  const EstimatorOptions without_degree = WithoutDegree(options);
  std::string why_not =
      IsForMaterialFit(scene)
          ? IterativeFe().WhyUnsupported(scene, without_degree)
          : ReducedFe().WhyUnsupported(scene, without_degree);
  if (why_not.empty() ||
      VirtualFields().WhyUnsupported(scene, options).empty()) {
    return "";
  }
  return why_not;
}

Estimate Auto::DoRun(const Scene& scene,
                     const EstimatorOptions& options) const {
  const EstimatorOptions without_degree = WithoutDegree(options);
  Ladder ladder;
  if (ladder.Climb(ClosedForm(), scene, without_degree) &&
      StopsHere(WhyClosedFormIsNotEnough(scene, options, ladder.Last()),
                ladder)) {
    return ladder.Finish();
  }
  if (IsForMaterialFit(scene)) {
    ClimbOverMaterials(scene, options, nullptr, ladder);
    return ladder.Finish();
  }
  std::optional<Estimate> virtual_fields;
  if (ladder.Climb(VirtualFields(VirtualFields::Check::kByEnergy), scene,
                   options)) {
    virtual_fields = ladder.Last();
    std::string why_not_enough = WhyNotEnough(scene, options, *virtual_fields);
    // A solution costs about what a reduced model does.
    if (why_not_enough.empty()) {
      ladder.Decide("went on: to hold it against a finite element solution");
      ladder.Climb(VirtualFields(), scene, options);
      why_not_enough = WhyNotEnough(scene, options, ladder.Last());
    }
    if (StopsHere(why_not_enough, ladder)) {
      return ladder.Finish();
    }
  }
  if (!ladder.Climb(ReducedFe(), scene, without_degree)) {
    return ladder.Finish();
  }
  CheckAgainst(virtual_fields, ladder.Last());
  const Estimate linear = ladder.Last();
  std::string why_not_enough = WhyTheModelIsNotEnough(options, linear);
  if (!why_not_enough.empty() && HasQuadraticKind(scene.mesh.kind) &&
      scene.mesh.NumElements() > kMostQuadraticElements) {
    ladder.Last().Add(TooManyElements());
    ladder.Decide("stopped: too many elements for order 2");
  } else if (why_not_enough.empty() || !HasQuadraticKind(scene.mesh.kind)) {
    ladder.Decide(why_not_enough.empty()
                      ? "stopped: at the statistical limit of the data"
                      : "stopped: there is no rung above");
  } else {
    ladder.Decide("went on: " + why_not_enough);
    ladder.Climb(ReducedFe(), QuadraticScene(scene), without_degree);
    // Linear elements that do not bear the balance say nothing of finer ones.
    if (virtual_fields &&
        !virtual_fields->Has(FindingCode::kVirtualWorkImbalance)) {
      CheckAgainst(virtual_fields, ladder.Last());
    }
    ChooseOrder(scene, options, linear, ladder);
  }
  NoteMismatch(ladder.Last());
  return ladder.Finish();
}

std::unique_ptr<Preparation> Auto::DoPrepare(
    const Scene& scene, const EstimatorOptions& options) const {
  if (HasUnknownMotion(scene)) {
    return std::make_unique<PreparedUnknownMotion>(options);
  }
  return Estimator::DoPrepare(scene, options);
}

}  // namespace elastimate
