#include "elastimate/estimators/displacement_fit/reduced_fe.h"

#include <cmath>
#include <optional>

#include "elastimate/core/scene/degrees_of_freedom.h"
#include "elastimate/core/scene/observed_displacements.h"
#include "elastimate/estimators/displacement_fit/adaptive_fit.h"
#include "elastimate/estimators/displacement_fit/displacement_fit.h"
#include "elastimate/estimators/displacement_fit/element_change.h"
#include "elastimate/estimators/displacement_fit/support_end_search.h"
#include "elastimate/estimators/interface/judge.h"
#include "elastimate/estimators/interface/stopwatch.h"
#include "elastimate/estimators/material_fit/material_fit.h"
#include "elastimate/estimators/statistics/bounded_parameter.h"
#include "elastimate/estimators/statistics/profile_likelihood.h"

namespace elastimate {
namespace {

Side BoundOf(const Bounds& bounds, double value) {
  constexpr double kOnBound = 1e-9;
  if (bounds.lower && value <= *bounds.lower * (1 + kOnBound)) {
    return Side::kLower;
  }
  if (bounds.upper && value >= *bounds.upper * (1 - kOnBound)) {
    return Side::kUpper;
  }
  return Side::kNone;
}

// The fit with what its elements miss.
DisplacementFit FitWithChange(const Scene& scene,
                              const ObservedDisplacements& observed,
                              const IsotropicElasticity& elasticity,
                              const SupportDoubt& doubt, ReducedModel& model,
                              ElementChange& change) {
  DisplacementFit fit = ExpandFit(model, observed, elasticity);
  // The model is zero where the supports hold.
  const Eigen::VectorXd held = HeldDisplacement(scene.supports);
  fit.displacement.colwise() += held;
  Eigen::MatrixXd responses = model.Responses(elasticity.poisson_ratio);
  if (model.HasSupportResponse()) {
    responses.rightCols<1>() += held;
  }
  fit.element_change =
      change.Rows(observed, elasticity, responses,
                  [&model](double nu) { return model.SolverNear(nu); });
  fit.supports = doubt;
  return fit;
}

// Fills in what follows from a fit of physical parameters.
void DescribeFit(const Scene& scene, const EstimatorOptions& options,
                 const ObservedDisplacements& observed,
                 const SupportDoubt& doubt, AdaptiveFit& adaptive,
                 ElementChange& change, Evidence& evidence,
                 Estimate& estimate) {
  const ModelFit& best = adaptive.Best();
  const BoundedParameter poisson_ratio =
      options.known_poisson_ratio
          ? BoundedParameter::Constant(*options.known_poisson_ratio)
          : BoundedParameter(best.point.poisson_ratio,
                             adaptive.PoissonRatioBounds());
  evidence.active = NoteActiveBounds(
      options,
      BoundOf(options.youngs_modulus, estimate.elasticity.youngs_modulus),
      poisson_ratio, estimate);
  const std::optional<double> variance = DescribeDisplacementFit(
      scene, adaptive.Model().Graph(), options, observed,
      FitWithChange(scene, observed, estimate.elasticity, doubt,
                    adaptive.Model(), change),
      best.losses, evidence, estimate);
  Judge(evidence, options, estimate);
  // What looks like a pull to -1 may be data that say nothing of nu.
  const bool is_at_minus_one = estimate.status == Status::kUnphysical;
  if (!variance || !(estimate.IsUsable() || is_at_minus_one)) {
    return;
  }
  const auto profile_of = [&](double quantile) {
    return adaptive.ProfileEnds(observed, quantile * *variance);
  };
  if (evidence.active.is_physical_limit ||
      ShareOfDistanceToPole(estimate) > kLargestLinearShare ||
      HasRivalMinimum(profile_of, estimate)) {
    evidence.profile_interval = DescribeProfile(profile_of, estimate);
  }
}

// Fits, and describes the fit.
Estimate RunAdaptiveFit(const Scene& scene, const EstimatorOptions& options,
                        const ObservedDisplacements& observed,
                        const SupportDoubt& doubt, AdaptiveFit& adaptive,
                        ElementChange& change) {
  Estimate estimate;
  Evidence evidence;
  Stopwatch stopwatch;
  const bool is_regular = adaptive.Run(observed);
  estimate.stages.push_back({"fit", stopwatch.Lap()});
  if (!is_regular) {
    evidence.end = End::kSingularStiffness;
    Judge(evidence, options, estimate);
    return estimate;
  }
  const ReducedFit::Point& best = adaptive.Best().point;
  estimate.elasticity = IsotropicElasticity::FromComplianceScale(
      best.compliance_scale, best.poisson_ratio, adaptive.Model().Section());
  evidence.do_displacements_oppose_loads =
      !estimate.elasticity.IsPhysical() ||
      !std::isfinite(estimate.elasticity.youngs_modulus);
  if (evidence.do_displacements_oppose_loads) {
    Judge(evidence, options, estimate);
    return estimate;
  }
  DescribeFit(scene, options, observed, doubt, adaptive, change, evidence,
              estimate);
  if (!adaptive.HasConverged()) {
    evidence.end = End::kNotCertified;
  }
  evidence.solver_notice = adaptive.Model().Notice();
  Judge(evidence, options, estimate);
  CorrectForElements(evidence, estimate);
  estimate.stages.push_back({"statistics", stopwatch.Lap()});
  return estimate;
}

Estimate FitOnce(const Scene& scene, const EstimatorOptions& options,
                 const SupportDoubt& doubt) {
  Stopwatch stopwatch;
  AdaptiveFit adaptive(scene, options);
  const ObservedDisplacements observed(scene);
  const double seconds = stopwatch.Lap();
  ElementChange change(scene);
  Estimate estimate =
      RunAdaptiveFit(scene, options, observed, doubt, adaptive, change);
  estimate.stages.insert(estimate.stages.begin(), {"reduce", seconds});
  estimate.work = adaptive.Model().WorkDone() + change.WorkDone();
  return estimate;
}

class ReducedPreparation : public Preparation {
 public:
  ReducedPreparation(const Scene& scene, const EstimatorOptions& options)
      : options_(options), adaptive_(scene, options), change_(scene) {}

  Estimate Run(const Scene& scene) override {
    if (!observed_) {
      observed_.emplace(scene);
    } else {
      observed_->Remeasure(scene);
    }
    const Work before = adaptive_.Model().WorkDone() + change_.WorkDone();
    Estimate estimate =
        RunAdaptiveFit(scene, options_, *observed_, {}, adaptive_, change_);
    estimate.work = adaptive_.Model().WorkDone() + change_.WorkDone() - before;
    return estimate;
  }

 private:
  const EstimatorOptions& options_;
  AdaptiveFit adaptive_;
  ElementChange change_;
  /// Empty before the first measurement.
  std::optional<ObservedDisplacements> observed_;
};

}  // namespace

std::string_view ReducedFe::Name() const { return "reduced-fe"; }

std::string_view ReducedFe::Description() const {
  return "maximum likelihood fit of the displacements by a reduced finite "
         "element model; unbiased, no initial guess, one or two "
         "factorisations";
}

Capabilities ReducedFe::WhatItTakes() const {
  Capabilities capabilities;
  capabilities.needs_supports = true;
  capabilities.takes_bounds = true;
  capabilities.takes_losses = true;
  capabilities.takes_materials = true;
  capabilities.takes_free_axes = true;
  return capabilities;
}

Estimate ReducedFe::DoRun(const Scene& scene,
                          const EstimatorOptions& options) const {
  if (IsForMaterialFit(scene)) {
    return FitMaterials(scene, options, Descent::kReduced);
  }
  return FitAndFindSupportEnds(
      scene, options,
      [&options](const Scene& ended, const SupportDoubt& doubt) {
        return FitOnce(ended, options, doubt);
      });
}

std::unique_ptr<Preparation> ReducedFe::DoPrepare(
    const Scene& scene, const EstimatorOptions& options) const {
  if (IsForMaterialFit(scene)) {
    return PrepareMaterialFit(options, Descent::kReduced);
  }
  return scene.supports.ends.empty()
             ? std::make_unique<ReducedPreparation>(scene, options)
             : Estimator::DoPrepare(scene, options);
}

}  // namespace elastimate
