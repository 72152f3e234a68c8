#include "elastimate/estimators/displacement_fit/reduced_fe.h"

#include <cmath>
#include <optional>
#include <utility>
#include <vector>

#include "elastimate/core/algebra/node_sums.h"
#include "elastimate/core/equilibrium/hierarchical_error.h"
#include "elastimate/core/scene/degrees_of_freedom.h"
#include "elastimate/core/scene/observed_displacements.h"
#include "elastimate/estimators/displacement_fit/adaptive_fit.h"
#include "elastimate/estimators/displacement_fit/corrected_fit.h"
#include "elastimate/estimators/displacement_fit/displacement_fit.h"
#include "elastimate/estimators/displacement_fit/support_end_search.h"
#include "elastimate/estimators/interface/judge.h"
#include "elastimate/estimators/interface/stopwatch.h"
#include "elastimate/estimators/material_fit/material_fit.h"
#include "elastimate/estimators/misfit/element_change.h"
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
  fit.element_change =
      change.Rows(observed, elasticity, [&](double nu) -> ElementChange::Model {
        Eigen::MatrixXd responses = model.Responses(nu);
        if (model.HasSupportResponse()) {
          responses.rightCols<1>() += held;
        }
        return {responses, model.SolverNear(nu)};
      });
  fit.supports = doubt;
  return fit;
}

// Fits of a reduced model to its measurement, or to what is left of it.
class CorrectableAdaptiveFit : public CorrectableFit {
 public:
  // `observed` was fitted.
  CorrectableAdaptiveFit(const Scene& scene, const EstimatorOptions& options,
                         const SupportDoubt& doubt,
                         const ObservedDisplacements& observed,
                         AdaptiveFit& adaptive, ElementChange& change)
      : scene_(scene),
        options_(options),
        doubt_(doubt),
        measured_(observed.Measured()),
        adaptive_(adaptive),
        change_(change),
        data_(observed) {}

  bool Fit(const Eigen::VectorXd& taken) override {
    taken_ = taken;
    data_.SetMeasured(WhatIsLeft(measured_, taken));
    return adaptive_.Run(data_, HierarchicalError::kTolerance * Norm(taken)) &&
           IsPhysicalFit(adaptive_);
  }

  // All of the range costs no more.
  bool FitNear(const IsotropicElasticity& /*start*/,
               const Eigen::VectorXd& taken) override {
    return Fit(taken);
  }

  DescribedFit Describe() override {
    DescribedFit described;
    Estimate& estimate = described.estimate;
    const ModelFit& best = adaptive_.Best();
    estimate.elasticity = ElasticityOf(adaptive_);
    const BoundedParameter poisson_ratio =
        options_.known_poisson_ratio
            ? BoundedParameter::Constant(*options_.known_poisson_ratio)
            : BoundedParameter(best.point.poisson_ratio,
                               adaptive_.PoissonRatioBounds());
    described.evidence.active = NoteActiveBounds(
        options_,
        BoundOf(options_.youngs_modulus, estimate.elasticity.youngs_modulus),
        poisson_ratio, estimate);
    DisplacementFit fit = FitWithChange(scene_, data_, estimate.elasticity,
                                        doubt_, adaptive_.Model(), change_);
    fit.taken = taken_;
    described.statistics = DescribeDisplacementFit(
        scene_, adaptive_.Model().Graph(), options_, data_, fit, best.losses,
        described.evidence, estimate);
    described.element_change = std::move(fit.element_change);
    described.sensitivities = fit.sensitivities;
    described.taken = taken_;
    return described;
  }

  Profile RangeWithin(double excess) override {
    return adaptive_.ProfileEnds(data_, excess);
  }

  std::optional<FitAtRatio> FitAt(double poisson_ratio) override {
    data_.SetMeasured(measured_);
    const DisplacementFit unit =
        ExpandFit(adaptive_.Model(), data_, {1, poisson_ratio});
    // The residual is t w + v - q, du / d ln E = -t w.
    const Eigen::VectorXd w = -unit.sensitivities.col(0);
    const double ratio = 1 - InnerProduct(w, unit.residual) / SquaredNorm(w);
    if (!(ratio > 0) || !std::isfinite(ratio)) {
      return std::nullopt;
    }
    const IsotropicElasticity elasticity = {1 / ratio, poisson_ratio};
    const DisplacementFit fit = FitWithChange(scene_, data_, elasticity, doubt_,
                                              adaptive_.Model(), change_);
    if (!fit.element_change) {
      return std::nullopt;
    }
    return FitAtRatio{elasticity, fit.residual, fit.sensitivities,
                      *fit.element_change};
  }

  // What was fitted last.
  const ObservedDisplacements& Data() const { return data_; }

 private:
  const Scene& scene_;
  const EstimatorOptions& options_;
  const SupportDoubt& doubt_;
  const Eigen::VectorXd measured_;
  AdaptiveFit& adaptive_;
  ElementChange& change_;
  ObservedDisplacements data_;
  Eigen::VectorXd taken_;
};

void DescribeProfileOf(const EstimatorOptions& options,
                       const ObservedDisplacements& data,
                       const AdaptiveFit& adaptive, CorrectedFit& corrected) {
  Estimate& estimate = corrected.fit.estimate;
  Evidence& evidence = corrected.fit.evidence;
  Judge(evidence, options, estimate);
  // What looks like a pull to -1 may be data that say nothing of nu.
  const bool is_at_minus_one = estimate.status == Status::kUnphysical;
  if (!corrected.fit.statistics.row_variance ||
      !(estimate.IsUsable() || is_at_minus_one)) {
    return;
  }
  const auto profile_of = [&](double quantile) {
    return corrected.WithRival(
        adaptive.ProfileEnds(data, corrected.ExcessOf(quantile)));
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
                        const SupportDoubt& doubt, AdaptiveFit& adaptive,
                        ElementChange& change) {
  Stopwatch stopwatch;
  Evidence evidence;
  const bool is_regular = adaptive.Run(observed);
  std::vector<StageTime> stages = {{"fit", stopwatch.Lap()}};
  if (!is_regular) {
    evidence.end = End::kSingularStiffness;
    return Undescribed(options, {Estimate::kUnknown, Estimate::kUnknown},
                       evidence, stages);
  }
  const IsotropicElasticity uncorrected = ElasticityOf(adaptive);
  if (!IsPhysicalFit(adaptive)) {
    evidence.do_displacements_oppose_loads = true;
    return Undescribed(options, uncorrected, evidence, stages);
  }
  CorrectableAdaptiveFit fit(scene, options, doubt, observed, adaptive, change);
  CorrectedFit corrected = FitCorrected(scene, options, fit);
  DescribeProfileOf(options, fit.Data(), adaptive, corrected);
  DescribedFit& described = corrected.fit;
  if (!adaptive.HasConverged()) {
    described.evidence.end = End::kNotCertified;
  }
  described.evidence.solver_notice = adaptive.Model().Notice();
  Judge(described.evidence, options, described.estimate);
  CorrectForElements(described.evidence, uncorrected, described.estimate);
  stages.push_back({"statistics", stopwatch.Lap()});
  described.estimate.stages = stages;
  return described.estimate;
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
