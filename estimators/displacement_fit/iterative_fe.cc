#include "elastimate/estimators/displacement_fit/iterative_fe.h"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <limits>
#include <optional>
#include <utility>
#include <vector>

#include "elastimate/core/algebra/node_sums.h"
#include "elastimate/core/scene/unknown_motion.h"
#include "elastimate/estimators/displacement_fit/displacement_fit.h"
#include "elastimate/estimators/displacement_fit/displacement_minimum.h"
#include "elastimate/estimators/displacement_fit/displacement_profile.h"
#include "elastimate/estimators/displacement_fit/robust_reduced_fit.h"
#include "elastimate/estimators/force_balance/virtual_fields.h"
#include "elastimate/estimators/interface/judge.h"
#include "elastimate/estimators/interface/statistics.h"
#include "elastimate/estimators/interface/stopwatch.h"
#include "elastimate/estimators/material_fit/material_fit.h"
#include "elastimate/estimators/misfit/observed_model.h"
#include "elastimate/estimators/statistics/bounded_parameter.h"
#include "elastimate/estimators/statistics/node_losses.h"
#include "elastimate/estimators/statistics/profile_likelihood.h"

namespace elastimate {
namespace {

// Where the fit looks for a start, besides virtual-fields: in each decade of
// (1 + nu) / (1 - 2 nu), the scale on which the stiffness changes evenly, since
// the sum of squares can have several minima (that of a slender bar or a plate
// in bending has).
constexpr double kStartPoissonRatios[] = {-0.85, -0.5, 0.0,   0.3,
                                          0.45,  0.48, 0.495, 0.499};
// nu of virtual-fields, where it has one.
std::optional<double> VirtualFieldsPoissonRatio(
    const Scene& scene, const EstimatorOptions& options) {
  EstimatorOptions virtual_options;
  virtual_options.poisson_ratio = options.poisson_ratio;
  const VirtualFields virtual_fields;
  if (!virtual_fields.WhyUnsupported(scene, virtual_options).empty()) {
    return std::nullopt;
  }
  const double nu =
      virtual_fields.Run(scene, virtual_options).elasticity.poisson_ratio;
  return std::isfinite(nu) ? std::optional<double>(nu) : std::nullopt;
}

// The start points within the bounds, ascending, with the E that fits best
// there, unless the stiffness is singular.
std::vector<ProfilePoint> EvaluateStarts(const Scene& scene,
                                         const EstimatorOptions& options,
                                         ObservedModel& model) {
  std::vector<double> candidates;
  if (options.known_poisson_ratio) {
    candidates = {*options.known_poisson_ratio};
  } else {
    const Bounds bounds = EffectivePoissonRatioBounds(options);
    candidates.assign(std::begin(kStartPoissonRatios),
                      std::end(kStartPoissonRatios));
    const std::optional<double> nu = VirtualFieldsPoissonRatio(scene, options);
    if (nu) {
      candidates.push_back(*nu);
    }
    for (double& candidate : candidates) {
      candidate = std::clamp(candidate, *bounds.lower, *bounds.upper);
    }
    std::sort(candidates.begin(), candidates.end());
    candidates.erase(std::unique(candidates.begin(), candidates.end()),
                     candidates.end());
  }
  std::vector<ProfilePoint> starts;
  for (const double nu : candidates) {
    if (model.SetPoissonRatio(nu)) {
      starts.push_back(EvaluateProfile(options, model, nu));
    }
  }
  return starts;
}

// Whether cost and slopes show a minimum between two starts: the cost falls
// into the interval from both ends, or rises into it to an end that is lower.
bool HasMinimumBetween(const ProfilePoint& left, const ProfilePoint& right) {
  if (left.slope > 0 && right.slope >= 0) {
    return right.cost < left.cost;
  }
  if (left.slope <= 0 && right.slope < 0) {
    return left.cost < right.cost;
  }
  return left.slope <= 0 && right.slope >= 0;
}

// Where to descend from: the better end of every interval between starts that
// has a minimum, and the first and the last start where the cost falls beyond
// them.  Starts without a positive E are left out.
std::vector<IsotropicElasticity> BasinsOf(std::vector<ProfilePoint> starts) {
  starts.erase(std::remove_if(starts.begin(), starts.end(),
                              [](const ProfilePoint& start) {
                                return !start.elasticity.IsPhysical();
                              }),
               starts.end());
  std::vector<IsotropicElasticity> basins;
  if (starts.empty()) {
    return basins;
  }
  if (starts.front().slope >= 0) {
    basins.push_back(starts.front().elasticity);
  }
  for (std::size_t i = 1; i < starts.size(); ++i) {
    if (HasMinimumBetween(starts[i - 1], starts[i])) {
      const bool is_left_better = starts[i - 1].cost < starts[i].cost;
      basins.push_back(starts[is_left_better ? i - 1 : i].elasticity);
    }
  }
  if (starts.back().slope <= 0) {
    basins.push_back(starts.back().elasticity);
  }
  return basins;
}

// The profile at the nu of a minimum; of infinite cost where it was not
// reached.
ProfilePoint PointOf(const Minimum& minimum, DisplacementResidual& residual,
                     const EstimatorOptions& options) {
  const double nu = minimum.poisson_ratio.Value();
  if (!std::isfinite(minimum.cost) || !residual.Model().SetPoissonRatio(nu)) {
    return {{Estimate::kUnknown, nu}, std::numeric_limits<double>::infinity()};
  }
  return EvaluateProfile(options, residual.Model(), nu);
}

// The best of all that is reached.  Each is a point of the profile.
Minimum BestMinimum(const EstimatorOptions& options,
                    const std::vector<IsotropicElasticity>& basins,
                    DisplacementResidual& residual,
                    std::vector<ProfilePoint>& points) {
  Minimum best = Descend(options, basins.front(), residual);
  points.push_back(PointOf(best, residual, options));
  for (std::size_t i = 1; i < basins.size(); ++i) {
    Minimum other = Descend(options, basins[i], residual);
    points.push_back(PointOf(other, residual, options));
    if (other.cost < best.cost) {
      best = std::move(other);
    }
  }
  return best;
}

// Enters the interval of nu, after up to three looks at where each end may be.
void DescribeProfileOf(const EstimatorOptions& options,
                       const std::vector<ProfilePoint>& points,
                       const Eigen::VectorXd& row_weights, double row_variance,
                       DisplacementResidual& residual, Evidence& evidence,
                       Estimate& estimate) {
  EvaluatedProfile profile(
      points, {estimate.elasticity,
               SquaredNorm(row_weights.cwiseProduct(residual.Fit().residual))});
  const Bounds bounds = EffectivePoissonRatioBounds(options);
  const double nu = estimate.elasticity.poisson_ratio;
  constexpr double kSettled = 0.05;
  // About twice as far as the end is expected.
  const double far = 4 * estimate.PoissonRatioStandardError().value_or(0);
  for (const double limit : {*bounds.lower, *bounds.upper}) {
    const double first =
        limit < nu ? std::max(limit, nu - far) : std::min(limit, nu + far);
    double last_end = nu;
    // Nobody has looked at what lies beyond the last point.
    for (const double beyond : {first, limit, limit}) {
      const double end =
          profile.EndTowards(limit, kTwoSidedQuantile * row_variance)
              .poisson_ratio;
      if (end != limit &&
          std::abs(end - last_end) < kSettled * std::abs(end - nu)) {
        break;
      }
      last_end = end;
      const double next = end != limit ? end : beyond;
      if (next != nu && residual.Model().SetPoissonRatio(next)) {
        profile.Add(EvaluateWeightedProfile(options, row_weights,
                                            residual.Model(), next));
      }
    }
  }
  evidence.profile_interval = DescribeProfile(
      [&](double quantile) -> Profile {
        const double excess = quantile * row_variance;
        return {profile.EndTowards(*bounds.lower, excess),
                profile.EndTowards(*bounds.upper, excess)};
      },
      estimate);
}

// A fit of a model to its measurement.
class IterativeFit {
 public:
  IterativeFit(const Scene& scene, const EstimatorOptions& options,
               ObservedModel& model)
      : scene_(scene), options_(options), model_(model), residual_(model) {}

  // Whether there is a fit of physical parameters.
  bool Fit() {
    points_ = EvaluateStarts(scene_, options_, model_);
    const std::vector<IsotropicElasticity> basins = BasinsOf(points_);
    if (basins.empty()) {
      return false;
    }
    best_.emplace(BestMinimum(options_, basins, residual_, points_));
    residual_.SetParameters(best_->meaning, &best_->scale,
                            &best_->poisson_ratio);
    residual_.PrepareForEvaluation(true, true);
    return residual_.IsValid() && residual_.Elasticity().IsPhysical();
  }

  // Describes the fit but for the profile likelihood.
  FitStatistics Describe(Evidence& evidence, Estimate& estimate) {
    estimate.elasticity = residual_.Elasticity();
    evidence.end = EndOf(best_->summary);
    evidence.search_message = "Ceres: " + best_->summary.message;
    evidence.active = NoteActiveBounds(options_, best_->violated,
                                       best_->poisson_ratio, estimate);
    return DescribeDisplacementFit(scene_, model_.Graph(), options_,
                                   model_.Observed(), residual_.Fit(),
                                   best_->losses, evidence, estimate);
  }

  bool HasBasin() const { return best_.has_value(); }
  bool IsValid() const { return residual_.IsValid(); }
  const Minimum& Best() const { return *best_; }
  DisplacementResidual& Residual() { return residual_; }
  /// Of the profile; with a loss of other weights than those of the fit.
  const std::vector<ProfilePoint>& Points() const { return points_; }

 private:
  const Scene& scene_;
  const EstimatorOptions& options_;
  ObservedModel& model_;
  DisplacementResidual residual_;
  std::vector<ProfilePoint> points_;
  std::optional<Minimum> best_;
};

// Enters the interval of nu where it is not that of a linear model.
void EnterProfile(const EstimatorOptions& options,
                  const FitStatistics& statistics, IterativeFit& fit,
                  Evidence& evidence, Estimate& estimate) {
  Judge(evidence, options, estimate);
  const std::optional<double>& variance = statistics.row_variance;
  if (!variance || !estimate.IsUsable() ||
      evidence.active.youngs_modulus != Side::kNone) {
    return;
  }
  DisplacementResidual& residual = fit.Residual();
  const NodeLosses& losses = fit.Best().losses;
  const Eigen::VectorXd row_weights =
      RowWeights(residual.Model().Observed(), residual.Fit().residual, losses);
  const std::vector<ProfilePoint> of_weights =
      losses.IsLeastSquares() ? fit.Points() : std::vector<ProfilePoint>();
  const double least =
      SquaredNorm(row_weights.cwiseProduct(residual.Fit().residual));
  const double nu = estimate.elasticity.poisson_ratio;
  const double far = 4 * estimate.PoissonRatioStandardError().value_or(0);
  const bool has_rival = std::any_of(
      of_weights.begin(), of_weights.end(), [&](const ProfilePoint& point) {
        return point.unbounded_cost <= least + kTwoSidedQuantile * *variance &&
               std::abs(point.unbounded.poisson_ratio - nu) > far;
      });
  if (evidence.active.is_physical_limit || has_rival ||
      ShareOfDistanceToPole(estimate) > kLargestLinearShare) {
    DescribeProfileOf(options, of_weights, row_weights, *variance, residual,
                      evidence, estimate);
  }
}

// What there is to say where there is no fit of physical parameters.
Evidence EvidenceOfNoFit(const IterativeFit& fit, Estimate& estimate) {
  Evidence evidence;
  if (!fit.HasBasin() && fit.Points().empty()) {
    evidence.end = End::kSingularStiffness;
  } else if (!fit.HasBasin()) {
    evidence.do_displacements_oppose_loads = true;
    estimate.elasticity = fit.Points().front().elasticity;
  } else {
    evidence.end = EndOf(fit.Best().summary);
    evidence.search_message = "Ceres: " + fit.Best().summary.message;
  }
  return evidence;
}

Estimate FitIteratively(const Scene& scene, const EstimatorOptions& options) {
  Stopwatch stopwatch;
  ObservedModel model(scene, options);
  std::vector<StageTime> stages = {{"assemble and analyse", stopwatch.Lap()}};
  IterativeFit fit(scene, options, model);
  const bool is_fitted = fit.Fit();
  stages.push_back({"fit", stopwatch.Lap()});
  Estimate estimate;
  Evidence evidence;
  if (is_fitted || (fit.HasBasin() && fit.IsValid())) {
    const FitStatistics statistics = fit.Describe(evidence, estimate);
    EnterProfile(options, statistics, fit, evidence, estimate);
  } else {
    evidence = EvidenceOfNoFit(fit, estimate);
  }
  evidence.solver_notice = model.SolverNotice();
  Judge(evidence, options, estimate);
  stages.push_back({"statistics", stopwatch.Lap()});
  estimate.stages = stages;
  estimate.work = model.WorkDone();
  return estimate;
}

}  // namespace

std::string_view IterativeFe::Name() const { return "iterative-fe"; }

std::string_view IterativeFe::Description() const {
  return "maximum likelihood fit of the displacements, a finite element "
         "solution at each step; unbiased, costs factorisations (reference)";
}

Capabilities IterativeFe::WhatItTakes() const {
  Capabilities capabilities;
  capabilities.needs_supports = true;
  capabilities.takes_bounds = true;
  capabilities.takes_losses = true;
  capabilities.takes_refinement = true;
  capabilities.takes_materials = true;
  capabilities.takes_free_axes = true;
  capabilities.takes_unknown_motion = true;
  capabilities.takes_supports_of_cases = true;
  return capabilities;
}

Estimate IterativeFe::DoRun(const Scene& scene,
                            const EstimatorOptions& options) const {
  if (IsForMaterialFit(scene)) {
    return FitMaterials(scene, options, Descent::kFull);
  }
  return FitIteratively(scene, options);
}

std::unique_ptr<Preparation> IterativeFe::DoPrepare(
    const Scene& scene, const EstimatorOptions& options) const {
  return IsForMaterialFit(scene) ? PrepareMaterialFit(options, Descent::kFull)
                                 : Estimator::DoPrepare(scene, options);
}

}  // namespace elastimate
