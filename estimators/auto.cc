#include "elastimate/estimators/auto.h"

#include <cmath>
#include <memory>

#include "elastimate/core/materials/isotropic_law.h"
#include "elastimate/core/scene/unknown_motion.h"
#include "elastimate/core/text/numbers.h"
#include "elastimate/estimators/force_balance/closed_form.h"
#include "elastimate/estimators/force_balance/virtual_fields.h"
#include "elastimate/estimators/interface/finding_sentences.h"
#include "elastimate/estimators/interface/judge.h"
#include "elastimate/estimators/interface/kinematic_error.h"
#include "elastimate/estimators/interface/limits.h"
#include "elastimate/estimators/interface/stopwatch.h"
#include "elastimate/estimators/material_fit/iterative_fe.h"
#include "elastimate/estimators/material_fit/large_strain_choice.h"
#include "elastimate/estimators/material_fit/material_fit.h"
#include "elastimate/estimators/material_fit/reduced_fe.h"

namespace elastimate {
namespace {

EstimatorOptions WithoutDegree(EstimatorOptions options) {
  options.virtual_field_degree.reset();
  return options;
}

// Why the standard errors of an estimate are too large; empty when they are
// not.
std::string WhyNotWithinTolerance(const Estimate& estimate) {
  for (const ParameterEstimate& parameter : estimate.parameters) {
    if (parameter.is_known) {
      continue;
    }
    if (!parameter.standard_error) {
      return "no standard error is known";
    }
    const double error = *parameter.standard_error / parameter.ErrorUnit();
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

// For a rung whose errors may come from its method; empty when it will do.
std::string WhyNotEnough(const Estimate& estimate) {
  // No other fit of small strains takes displacements that are too large for
  // this one.
  if (estimate.IsRefusedFor(FindingCode::kLargeDeformation)) {
    return "";
  }
  if (!estimate.IsUsable()) {
    return WhyNotUsable(estimate);
  }
  for (const Finding& finding : estimate.findings) {
    if (finding.severity == Severity::kWarning &&
        finding.code != FindingCode::kLargeDeformation &&
        finding.code != FindingCode::kNegativePoissonRatio &&
        finding.code != FindingCode::kMarginNotGiven &&
        finding.code != FindingCode::kPriorContradicted) {
      return "it warns: " + finding.text;
    }
  }
  return WhyNotWithinTolerance(estimate);
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
      // Without advice, as the climb itself goes on to what would help.
      rung.decision = "passed over: " + why_not.substr(0, why_not.find("; "));
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
    // A fit of measured displacements ends at quadratic elements.
    rung.element_order = estimate_.element_order;
    work_ = work_ + estimate_.work;
    for (const StageTime& stage : estimate_.stages) {
      stages_.push_back({std::string(estimator.Name()) +
                             (rung.element_order == 2 ? " (order 2): " : ": ") +
                             stage.stage,
                         stage.seconds});
    }
    rung.status = estimate_.status;
    if (std::isfinite(estimate_.elasticity.youngs_modulus)) {
      rung.elasticity = estimate_.elasticity;
    }
    rung.work = estimate_.work;
    rung.seconds = estimate_.seconds;
    rungs_.push_back(rung);
    return true;
  }

  void Decide(const std::string& decision) {
    rungs_.back().decision = decision;
  }
  /// The estimate of the last rung that ran.
  Estimate& Last() { return estimate_; }

  Estimate Finish() {
    for (Finding& finding : estimate_.findings) {
      finding = WithoutAdviceOfAuto(finding);
      if (finding.severity == Severity::kError) {
        estimate_.message = Sentence(finding);
      }
    }
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
  ladder.Decide(why_not_enough.empty() ? "stopped: it is accurate enough"
                                       : "went on: " + why_not_enough);
  return why_not_enough.empty();
}

// The fits of displacements, which alone see what the elements miss, and
// whether regions are right.
void ClimbFits(const Scene& scene, const EstimatorOptions& options,
               Preparation* fit, Ladder& ladder) {
  const EstimatorOptions without_degree = WithoutDegree(options);
  if (ReducedFe().WhyUnsupported(scene, without_degree).empty()) {
    ladder.Climb(ReducedFe(), scene, without_degree);
    const Estimate& reduced = ladder.Last();
    if (!reduced.Has(FindingCode::kFitNotCertified) &&
        reduced.status != Status::kNumericalFailure) {
      ladder.Decide(reduced.IsUsable()
                        ? "stopped: at the statistical limit of the data"
                        : "stopped: no further estimator would do better");
      return;
    }
    ladder.Decide("went on: " + WhyNotUsable(reduced));
  }
  if (!ladder.Climb(IterativeFe(), scene, without_degree, fit) &&
      !ladder.Climb(VirtualFields(), scene, options)) {
    return;
  }
  ladder.Decide("stopped: no further estimator would do better");
}

bool ClimbLargeStrainLaws(const Scene& scene, const EstimatorOptions& options,
                          Ladder& ladder) {
  EstimatorOptions large = WithoutDegree(options);
  large.kinematics = Kinematics::kLarge;
  return ladder.Climb(IterativeFe(), scene, large);
}

// Laws of large strains in place of isotropic ones, where they are asked for.
// Tells whether they end the climb: what is not usable, or not determined, may
// have another cause, which fits of small strains name.
bool ClimbLargeStrains(const Scene& scene, const EstimatorOptions& options,
                       Ladder& ladder) {
  if (HasFields(scene.materials) || !AsksForLargeStrains(scene, options) ||
      !ClimbLargeStrainLaws(scene, options, ladder)) {
    return false;
  }
  const Estimate& estimate = ladder.Last();
  if (estimate.DeterminesAll() || options.kinematics == Kinematics::kLarge) {
    ladder.Decide("stopped: laws of large strains were fitted");
    return true;
  }
  ladder.Decide("went on: " + (estimate.IsUsable() ? WhyNotEnough(estimate)
                                                   : WhyNotUsable(estimate)));
  return false;
}

// Which laws computed displacements is not said: where they are large, small
// strains leave more than noise, and laws of large strains less, these did.
void ClimbComputedLargeStrains(const Scene& scene,
                               const EstimatorOptions& options,
                               Ladder& ladder) {
  const Estimate small = ladder.Last();
  const bool has_minimum = small.status != Status::kIterationLimit &&
                           small.status != Status::kNumericalFailure;
  if (options.kinematics != Kinematics::kAutomatic ||
      scene.origin != Origin::kComputed || scene.is_rigid_motion_free ||
      !AreIsotropic(scene.materials) || !IsMentioned(small.deformation) ||
      !has_minimum ||
      !(small.Has(FindingCode::kSmoothResidual) ||
        small.Has(FindingCode::kResidualAboveNoise)) ||
      !ClimbLargeStrainLaws(scene, options, ladder)) {
    return;
  }
  const Estimate& large = ladder.Last();
  if (!(large.displacement_residual < small.displacement_residual)) {
    ladder.Decide("not taken: laws of large strains do not explain more");
    ladder.Last() = small;
  } else if (!large.IsUsable() && small.IsUsable()) {
    ladder.Decide("not taken: " + WhyNotUsable(large));
    ladder.Last() = small;
  } else {
    // Where neither is usable, it matters why the better one is not.
    ladder.Decide("stopped: laws of large strains explain more");
  }
}

// Unknown motions have one rung, iterative-fe.
class PreparedUnknownMotion : public Preparation {
 public:
  PreparedUnknownMotion(const Scene& scene, const EstimatorOptions& options)
      : options_(WithoutDegree(options)),
        fit_(PrepareMaterialFit(scene, options_, Descent::kFull)) {}

  Estimate Run(const Scene& scene) override {
    Ladder ladder;
    ClimbFits(scene, options_, fit_.get(), ladder);
    return ladder.Finish();
  }
  bool TakesOtherLoadCases() const override { return true; }
  void ForgetStart() override { fit_->ForgetStart(); }

 private:
  EstimatorOptions options_;
  std::unique_ptr<Preparation> fit_;
};

}  // namespace

std::string_view Auto::Name() const { return "auto"; }

std::string_view Auto::Description() const {
  return "tries closed-form, virtual-fields, reduced-fe and iterative-fe until "
         "the estimate is accurate enough; for measured displacements it "
         "begins with the last two, which alone know the error of the mesh";
}

Capabilities Auto::WhatItTakes() const {
  Capabilities capabilities;
  capabilities.takes_bounds = true;
  capabilities.takes_losses = true;
  capabilities.takes_refinement = true;
  capabilities.takes_degree = true;
  capabilities.takes_materials = true;
  capabilities.takes_free_axes = true;
  capabilities.takes_fields = true;
  capabilities.takes_large_strains = true;
  capabilities.compares_large_strain_laws = true;
  capabilities.takes_unknown_motion = true;
  capabilities.takes_supports_of_cases = true;
  return capabilities;
}

std::string Auto::WhyUnsupported(const Scene& scene,
                                 const EstimatorOptions& options) const {
  const EstimatorOptions without_degree = WithoutDegree(options);
  const std::string why_not =
      IterativeFe().WhyUnsupported(scene, without_degree);
  return VirtualFields().WhyUnsupported(scene, options).empty() ? "" : why_not;
}

Estimate Auto::DoRun(const Scene& scene,
                     const EstimatorOptions& options) const {
  const EstimatorOptions without_degree = WithoutDegree(options);
  Ladder ladder;
  if (ClimbLargeStrains(scene, options, ladder)) {
    return ladder.Finish();
  }
  const Estimate of_large_strains = ladder.Last();
  // The balance of forces knows no mesh error of measured displacements.
  if (scene.origin != Origin::kMeasured) {
    if (ladder.Climb(ClosedForm(), scene, without_degree) &&
        StopsHere(WhyNotEnough(ladder.Last()), ladder)) {
      return ladder.Finish();
    }
    if (IsOneIsotropicMaterial(scene.materials) &&
        ladder.Climb(VirtualFields(), scene, options) &&
        StopsHere(WhyNotEnough(ladder.Last()), ladder)) {
      return ladder.Finish();
    }
  }
  ClimbFits(scene, options, nullptr, ladder);
  ClimbComputedLargeStrains(scene, options, ladder);
  // Where small strains do not do, it matters why large ones did not either.
  if (!of_large_strains.Has(FindingCode::kNotRun) &&
      ladder.Last().IsRefusedFor(FindingCode::kLargeDeformation) &&
      IsPossible(ladder.Last().deformation)) {
    ladder.Decide("not taken: the strains are too large for it");
    ladder.Last() = of_large_strains;
  }
  return ladder.Finish();
}

std::unique_ptr<Preparation> Auto::DoPrepare(
    const Scene& scene, const EstimatorOptions& options) const {
  if (HasUnknownMotion(scene)) {
    return std::make_unique<PreparedUnknownMotion>(scene, options);
  }
  return Estimator::DoPrepare(scene, options);
}

}  // namespace elastimate
