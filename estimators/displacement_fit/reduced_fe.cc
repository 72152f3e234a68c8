#include "elastimate/estimators/displacement_fit/reduced_fe.h"

#include <cmath>
#include <optional>
#include <utility>
#include <vector>

#include "elastimate/core/scene/degrees_of_freedom.h"
#include "elastimate/core/scene/observed_displacements.h"
#include "elastimate/estimators/displacement_fit/adaptive_fit.h"
#include "elastimate/estimators/displacement_fit/displacement_fit.h"
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

IsotropicElasticity ElasticityOf(const AdaptiveFit& adaptive) {
  const ReducedFit::Point& best = adaptive.Best().point;
  return IsotropicElasticity::FromComplianceScale(
      best.compliance_scale, best.poisson_ratio, adaptive.Model().Section());
}

bool IsPhysicalFit(const AdaptiveFit& adaptive) {
  const IsotropicElasticity elasticity = ElasticityOf(adaptive);
  return elasticity.IsPhysical() && std::isfinite(elasticity.youngs_modulus);
}

// Describes the fit but for the profile likelihood.
FitStatistics DescribeFit(const Scene& scene, const EstimatorOptions& options,
                          const ObservedDisplacements& observed,
                          AdaptiveFit& adaptive, Evidence& evidence,
                          Estimate& estimate) {
  const ModelFit& best = adaptive.Best();
  estimate.elasticity = ElasticityOf(adaptive);
  const BoundedParameter poisson_ratio =
      options.known_poisson_ratio
          ? BoundedParameter::Constant(*options.known_poisson_ratio)
          : BoundedParameter(best.point.poisson_ratio,
                             adaptive.PoissonRatioBounds());
  evidence.active = NoteActiveBounds(
      options,
      BoundOf(options.youngs_modulus, estimate.elasticity.youngs_modulus),
      poisson_ratio, estimate);
  DisplacementFit fit =
      ExpandFit(adaptive.Model(), observed, estimate.elasticity);
  // The model is zero where the supports hold.
  fit.displacement.colwise() += HeldDisplacement(scene.supports);
  return DescribeDisplacementFit(scene, adaptive.Model().Graph(), options,
                                 observed, fit, best.losses, evidence,
                                 estimate);
}

void DescribeProfileOf(const EstimatorOptions& options,
                       const ObservedDisplacements& observed,
                       const AdaptiveFit& adaptive,
                       const FitStatistics& statistics, Evidence& evidence,
                       Estimate& estimate) {
  Judge(evidence, options, estimate);
  // What looks like a pull to -1 may be data that say nothing of nu.
  const bool is_at_minus_one = estimate.status == Status::kUnphysical;
  if (!statistics.row_variance || !(estimate.IsUsable() || is_at_minus_one)) {
    return;
  }
  const auto profile_of = [&](double quantile) {
    return adaptive.ProfileEnds(observed, quantile * *statistics.row_variance);
  };
  if (evidence.active.is_physical_limit ||
      ShareOfDistanceToPole(estimate) > kLargestLinearShare ||
      HasRivalMinimum(profile_of, estimate)) {
    evidence.profile_interval = DescribeProfile(profile_of, estimate);
  }
}

// Of a fit that cannot be described.
Estimate Undescribed(const EstimatorOptions& options,
                     const IsotropicElasticity& elasticity,
                     const Evidence& evidence,
                     const std::vector<StageTime>& stages) {
  Estimate estimate;
  estimate.stages = stages;
  estimate.elasticity = elasticity;
  Judge(evidence, options, estimate);
  return estimate;
}

// Fits, and describes the fit.
Estimate RunAdaptiveFit(const Scene& scene, const EstimatorOptions& options,
                        const ObservedDisplacements& observed,
                        AdaptiveFit& adaptive) {
  Stopwatch stopwatch;
  Evidence evidence;
  const bool is_regular = adaptive.Run(observed);
  std::vector<StageTime> stages = {{"fit", stopwatch.Lap()}};
  if (!is_regular) {
    evidence.end = End::kSingularStiffness;
    return Undescribed(options, {Estimate::kUnknown, Estimate::kUnknown},
                       evidence, stages);
  }
  if (!IsPhysicalFit(adaptive)) {
    evidence.do_displacements_oppose_loads = true;
    return Undescribed(options, ElasticityOf(adaptive), evidence, stages);
  }
  Estimate estimate;
  const FitStatistics statistics =
      DescribeFit(scene, options, observed, adaptive, evidence, estimate);
  DescribeProfileOf(options, observed, adaptive, statistics, evidence,
                    estimate);
  if (!adaptive.HasConverged()) {
    evidence.end = End::kNotCertified;
  }
  evidence.solver_notice = adaptive.Model().Notice();
  Judge(evidence, options, estimate);
  stages.push_back({"statistics", stopwatch.Lap()});
  estimate.stages = stages;
  return estimate;
}

class ReducedPreparation : public Preparation {
 public:
  ReducedPreparation(const Scene& scene, const EstimatorOptions& options)
      : options_(options), adaptive_(scene, options) {}

  Estimate Run(const Scene& scene) override {
    if (!observed_) {
      observed_.emplace(scene);
    } else {
      observed_->Remeasure(scene);
    }
    const Work before = adaptive_.Model().WorkDone();
    Estimate estimate = RunAdaptiveFit(scene, options_, *observed_, adaptive_);
    estimate.work = adaptive_.Model().WorkDone() - before;
    return estimate;
  }

 private:
  const EstimatorOptions& options_;
  AdaptiveFit adaptive_;
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
  capabilities.takes_refinement = true;
  capabilities.takes_materials = true;
  capabilities.takes_free_axes = true;
  return capabilities;
}

Estimate ReducedFe::DoRun(const Scene& scene,
                          const EstimatorOptions& options) const {
  if (IsForMaterialFit(scene)) {
    return FitMaterials(scene, options, Descent::kReduced);
  }
  Stopwatch stopwatch;
  AdaptiveFit adaptive(scene, options);
  const ObservedDisplacements observed(scene);
  const double seconds = stopwatch.Lap();
  Estimate estimate = RunAdaptiveFit(scene, options, observed, adaptive);
  estimate.stages.insert(estimate.stages.begin(), {"reduce", seconds});
  estimate.work = adaptive.Model().WorkDone();
  return estimate;
}

std::unique_ptr<Preparation> ReducedFe::DoPrepare(
    const Scene& scene, const EstimatorOptions& options) const {
  if (IsForMaterialFit(scene)) {
    return PrepareMaterialFit(options, Descent::kReduced);
  }
  return std::make_unique<ReducedPreparation>(scene, options);
}

}  // namespace elastimate
