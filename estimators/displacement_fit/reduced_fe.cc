#include "elastimate/estimators/displacement_fit/reduced_fe.h"

#include <cmath>
#include <optional>
#include <stdexcept>
#include <string>

#include "elastimate/estimators/displacement_fit/adaptive_fit.h"
#include "elastimate/estimators/displacement_fit/displacement_fit.h"
#include "elastimate/estimators/displacement_fit/observed_displacements.h"
#include "elastimate/estimators/interface/input_checks.h"
#include "elastimate/estimators/interface/judge.h"
#include "elastimate/estimators/interface/stopwatch.h"
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

// Fills in what follows from a fit of physical parameters.
void DescribeFit(const Scene& scene, const EstimatorOptions& options,
                 const ObservedDisplacements& observed,
                 const AdaptiveFit& adaptive, Evidence& evidence,
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
      ExpandFit(adaptive.Model(), observed, estimate.elasticity), best.losses,
      evidence, estimate);
  Judge(evidence, options, estimate);
  // What looks like a pull to -1 may be data that say nothing of nu.
  const bool is_at_minus_one = estimate.status == Status::kUnphysical;
  if (!variance || options.loss != Loss::kNone ||
      !(estimate.IsUsable() || is_at_minus_one)) {
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
                        AdaptiveFit& adaptive) {
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
  DescribeFit(scene, options, observed, adaptive, evidence, estimate);
  if (!adaptive.HasConverged()) {
    evidence.end = End::kNotCertified;
  }
  evidence.solver_notice = adaptive.Model().Notice();
  Judge(evidence, options, estimate);
  estimate.stages.push_back({"statistics", stopwatch.Lap()});
  return estimate;
}

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
  return capabilities;
}

Estimate ReducedFe::DoRun(const Scene& scene,
                          const EstimatorOptions& options) const {
  Stopwatch stopwatch;
  AdaptiveFit adaptive(scene, options);
  const ObservedDisplacements observed(scene);
  const double seconds = stopwatch.Lap();
  Estimate estimate = RunAdaptiveFit(scene, options, observed, adaptive);
  estimate.stages.insert(estimate.stages.begin(), {"reduce", seconds});
  estimate.work = adaptive.Model().WorkDone();
  return estimate;
}

struct PreparedReducedFe::State {
  State(const Scene& unmeasured_scene, const EstimatorOptions& given_options)
      : scene(unmeasured_scene),
        options(given_options),
        adaptive(scene, options) {}

  Scene scene;
  EstimatorOptions options;
  AdaptiveFit adaptive;
  /// Empty before the first measurement.
  std::unique_ptr<ObservedDisplacements> observed;
};

PreparedReducedFe::PreparedReducedFe(const Scene& scene,
                                     const EstimatorOptions& options) {
  Scene unmeasured = scene;
  for (LoadCase& load_case : unmeasured.load_cases) {
    load_case.displacement.resize(scene.mesh.Dimension(), 0);
  }
  ValidateScene(unmeasured);
  CheckOptions(options);
  CheckSupported(ReducedFe(), unmeasured, options);
  state_ = std::make_unique<State>(unmeasured, options);
}

PreparedReducedFe::~PreparedReducedFe() = default;
PreparedReducedFe::PreparedReducedFe(PreparedReducedFe&&) noexcept = default;
PreparedReducedFe& PreparedReducedFe::operator=(PreparedReducedFe&&) noexcept =
    default;

Estimate PreparedReducedFe::Run(
    const std::vector<Eigen::MatrixXd>& displacements) {
  Stopwatch stopwatch;
  Scene& scene = state_->scene;
  if (displacements.size() != scene.load_cases.size()) {
    throw std::invalid_argument(std::to_string(displacements.size()) +
                                " measured displacements for " +
                                std::to_string(scene.load_cases.size()) +
                                " load cases; give one for each");
  }
  for (std::size_t k = 0; k < displacements.size(); ++k) {
    scene.load_cases[k].displacement = displacements[k];
  }
  ValidateMeasurements(scene);
  const std::vector<Finding> findings = CheckMeasurements(scene);
  if (!state_->observed) {
    state_->observed = std::make_unique<ObservedDisplacements>(scene);
  } else {
    state_->observed->Remeasure(scene);
  }
  const Work before = state_->adaptive.Model().WorkDone();
  Estimate estimate = RunAdaptiveFit(scene, state_->options, *state_->observed,
                                     state_->adaptive);
  estimate.work = state_->adaptive.Model().WorkDone() - before;
  FinishEstimate(ReducedFe(), scene, state_->options, findings, estimate);
  estimate.seconds = stopwatch.Lap();
  return estimate;
}

}  // namespace elastimate
