#include "elastimate/estimators/reduced_fe.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <stdexcept>
#include <string>

#include "elastimate/estimators/bounded_parameter.h"
#include "elastimate/estimators/checks.h"
#include "elastimate/estimators/displacement_fit.h"
#include "elastimate/estimators/node_losses.h"
#include "elastimate/estimators/observed_displacements.h"
#include "elastimate/estimators/profile_likelihood.h"
#include "elastimate/estimators/reduced_fit.h"
#include "elastimate/estimators/reduced_model.h"
#include "elastimate/estimators/statistics.h"
#include "elastimate/estimators/stopwatch.h"

namespace elastimate {
namespace {

// The first pole, unless nu is known or bounded away from it.
constexpr double kFirstPole = 0.3;
// Where, and how well, the model is refined before its first use.
constexpr double kFirstRefinements[] = {-0.5, 0.45};
constexpr double kFirstTolerance = 1e-2;
// The certified error that may remain, relative to the noise, and at least.
constexpr double kToleranceOverNoise = 0.1;
constexpr double kSmallestTolerance = 1e-8;
// A factorisation costs as much as 30 (45 000 tetrahedra) to 100 (300 000)
// solves, and the vectors of all poles are kept.
constexpr int kMostVectorsOfAPole = 20;
constexpr int kMostPoles = 4;

// A fit of the model as it is.
struct ModelFit {
  ReducedFit::Point point;
  /// Of the residuals.
  double standard_deviation;
  NodeLosses losses;
};

Eigen::VectorXd Residual(const ReducedModel& model,
                         const ObservedDisplacements& observed,
                         const ReducedFit::Point& point) {
  return ExpandFit(model, observed,
                   IsotropicElasticity::FromComplianceScale(
                       point.compliance_scale, point.poisson_ratio))
      .residual;
}

// The start of a robust fit: the nu and t of least absolute deviations.
ReducedFit::Point LeastAbsoluteDeviationsFit(
    const ReducedModel& model, const ObservedDisplacements& observed,
    const Bounds& poisson_ratio) {
  ReducedFit::Point best = {kFirstPole, Estimate::kUnknown,
                            std::numeric_limits<double>::infinity()};
  for (const double candidate : {-0.5, 0.0, 0.3, 0.45}) {
    const double nu =
        std::clamp(candidate, *poisson_ratio.lower, *poisson_ratio.upper);
    // At E = 1: u = t w + v and du / d ln E = -t w.
    const IsotropicElasticity unit = {1, nu};
    const DisplacementFit fit = ExpandFit(model, observed, unit);
    const Eigen::VectorXd w =
        -fit.sensitivities.col(0) / unit.ComplianceScale();
    if (w.isZero(0)) {
      continue;
    }
    const Eigen::VectorXd rest = -(fit.residual - unit.ComplianceScale() * w);
    const double t = LeastAbsoluteDeviations(w, rest);
    const double deviation = (rest - t * w).lpNorm<1>();
    const bool is_better = (t > 0) == (best.compliance_scale > 0)
                               ? deviation < best.square_sum
                               : t > 0;
    if (is_better) {
      best = {nu, t, deviation};
    }
  }
  return best;
}

Eigen::VectorXd RowWeights(const ObservedDisplacements& observed,
                           const Eigen::VectorXd& residual,
                           const NodeLosses& losses) {
  Eigen::VectorXd weights(observed.Size());
  for (const ObservedDisplacements::Node& node : observed.Nodes()) {
    const double square_sum =
        residual.segment(node.first, node.count).squaredNorm();
    weights.segment(node.first, node.count)
        .setConstant(std::sqrt(losses.Evaluate(node.count, square_sum)[1]));
  }
  return weights;
}

ModelFit FitRobustly(const ReducedModel& model,
                     const ObservedDisplacements& observed,
                     const EstimatorOptions& options,
                     const Bounds& poisson_ratio) {
  constexpr int kMostRescalings = 6;
  constexpr int kMostReweightings = 100;
  constexpr double kScaleTolerance = 0.01;
  constexpr double kPointTolerance = 1e-8;
  constexpr double kExactFit = 1e-12;
  ModelFit fit;
  fit.point = LeastAbsoluteDeviationsFit(model, observed, poisson_ratio);
  Eigen::VectorXd residual = Residual(model, observed, fit.point);
  fit.standard_deviation = 0;
  for (int i = 0; i < kMostRescalings; ++i) {
    const double scale = std::max(kExactFit, RobustStandardDeviation(residual));
    if (std::abs(scale - fit.standard_deviation) <= kScaleTolerance * scale) {
      break;
    }
    fit.standard_deviation = scale;
    fit.losses = NodeLosses(options.loss, scale);
    for (int k = 0; k < kMostReweightings; ++k) {
      const ReducedFit::Point previous = fit.point;
      fit.point = ReducedFit(model, observed,
                             RowWeights(observed, residual, fit.losses),
                             poisson_ratio, options.youngs_modulus)
                      .Fit(observed.Measured());
      residual = Residual(model, observed, fit.point);
      if (std::abs(fit.point.poisson_ratio - previous.poisson_ratio) <=
              kPointTolerance &&
          std::abs(fit.point.compliance_scale - previous.compliance_scale) <=
              kPointTolerance * std::abs(fit.point.compliance_scale)) {
        break;
      }
    }
  }
  return fit;
}

// Refines the model where the fit goes until the fit is as good as the full
// model's.
class AdaptiveFit {
 public:
  // `scene` must outlive this object.
  AdaptiveFit(const Scene& scene, const EstimatorOptions& options)
      : options_(options),
        poisson_ratio_(options.known_poisson_ratio
                           ? Bounds{options.known_poisson_ratio,
                                    options.known_poisson_ratio}
                           : EffectivePoissonRatioBounds(options)),
        model_(scene, options.solver) {
    const auto within = [this](double nu) {
      return std::clamp(nu, *poisson_ratio_.lower, *poisson_ratio_.upper);
    };
    is_regular_ = SetPole(within(kFirstPole));
    if (is_regular_) {
      for (const double nu : kFirstRefinements) {
        Refine(within(nu), kFirstTolerance);
      }
      if (options.known_poisson_ratio) {
        // A residual elsewhere holds dw/dnu, which is for the statistics.
        const double nu = *options.known_poisson_ratio;
        model_.Refine(nu < 0.4 ? nu + 0.05 : nu - 0.05, 0);
      }
    }
  }

  // False when the stiffness is singular at a pole.
  bool Run(const ObservedDisplacements& observed) {
    has_converged_ = false;
    while (is_regular_) {
      Fit(observed);
      const double nu = fit_.point.poisson_ratio;
      const double tolerance = std::max(
          kSmallestTolerance, kToleranceOverNoise * fit_.standard_deviation /
                                  observed.Measured().norm());
      if (IsCertified(nu, tolerance) || RefineOnce(nu, tolerance)) {
        has_converged_ = true;
        break;
      }
      if (Refine(nu, tolerance)) {
        continue;
      }
      if (num_poles_ == kMostPoles) {
        break;
      }
      is_regular_ = SetPole(nu);
    }
    return is_regular_;
  }

  // The ends of the interval of nu in which the sum of squares of the last fit
  // without a loss exceeds its least by no more than `excess`.
  Profile ProfileEnds(const ObservedDisplacements& observed,
                      double excess) const {
    const auto elasticity_of = [](const ReducedFit::Point& point) {
      return IsotropicElasticity::FromComplianceScale(point.compliance_scale,
                                                      point.poisson_ratio);
    };
    const auto [lower, upper] =
        least_squares_->ProfileEnds(observed.Measured(), fit_.point, excess);
    return {elasticity_of(lower), elasticity_of(upper)};
  }

  const ModelFit& Best() const { return fit_; }
  bool HasConverged() const { return has_converged_; }
  const Bounds& PoissonRatioBounds() const { return poisson_ratio_; }
  const ReducedModel& Model() const { return model_; }

 private:
  // Where the error of the model was found to be below a bound.
  struct Certificate {
    double poisson_ratio;
    double error_bound;
  };

  bool SetPole(double nu) {
    if (options_.on_factorization) {
      options_.on_factorization(num_poles_ + 1);
    }
    ++num_poles_;
    num_vectors_of_pole_ = 0;
    return model_.SetPole(nu);
  }

  // Whether the error at nu was below the tolerance; else it has been made
  // smaller.
  bool RefineOnce(double nu, double tolerance) {
    const double error_bound = model_.Refine(nu, tolerance);
    if (error_bound <= tolerance) {
      certificates_.push_back({nu, error_bound});
      return true;
    }
    ++num_vectors_of_pole_;
    return false;
  }

  // False when the pole has got its vectors before the error at nu is below
  // the tolerance.
  bool Refine(double nu, double tolerance) {
    while (num_vectors_of_pole_ < kMostVectorsOfAPole) {
      if (RefineOnce(nu, tolerance)) {
        return true;
      }
    }
    return false;
  }

  // The responses are analytic in nu within the distance to the nearer of -1
  // and 1/2, so that between two certified points much closer than that the
  // error is no larger than at them.
  bool IsCertified(double nu, double tolerance) const {
    constexpr double kClose = 0.1;
    const double radius = std::min(0.5 - nu, 1 + nu);
    double below = -std::numeric_limits<double>::infinity();
    double above = std::numeric_limits<double>::infinity();
    for (const Certificate& certificate : certificates_) {
      if (certificate.error_bound <= tolerance) {
        if (certificate.poisson_ratio <= nu) {
          below = std::max(below, certificate.poisson_ratio);
        }
        if (certificate.poisson_ratio >= nu) {
          above = std::min(above, certificate.poisson_ratio);
        }
      }
    }
    return above - below <= kClose * radius;
  }

  void Fit(const ObservedDisplacements& observed) {
    if (options_.loss != Loss::kNone) {
      fit_ = FitRobustly(model_, observed, options_, poisson_ratio_);
      return;
    }
    if (!least_squares_ || fitted_version_ != model_.Version()) {
      least_squares_ = std::make_unique<ReducedFit>(
          model_, observed, Eigen::VectorXd::Ones(observed.Size()),
          poisson_ratio_, options_.youngs_modulus);
      fitted_version_ = model_.Version();
    }
    fit_.point = least_squares_->Fit(observed.Measured());
    fit_.standard_deviation =
        std::sqrt(fit_.point.square_sum / static_cast<double>(observed.Size()));
  }

  EstimatorOptions options_;
  Bounds poisson_ratio_;
  ReducedModel model_;
  bool is_regular_;
  std::vector<Certificate> certificates_;
  /// Of the model at `fitted_version_`.
  std::unique_ptr<ReducedFit> least_squares_;
  int fitted_version_ = 0;
  ModelFit fit_;
  bool has_converged_ = false;
  int num_poles_ = 0;
  int num_vectors_of_pole_ = 0;
};

BoundedParameter::Side BoundOf(const Bounds& bounds, double value) {
  constexpr double kOnBound = 1e-9;
  if (bounds.lower && value <= *bounds.lower * (1 + kOnBound)) {
    return BoundedParameter::Side::kLower;
  }
  if (bounds.upper && value >= *bounds.upper * (1 - kOnBound)) {
    return BoundedParameter::Side::kUpper;
  }
  return BoundedParameter::Side::kNone;
}

// Fits, and describes the fit.
Estimate RunAdaptiveFit(const Scene& scene, const EstimatorOptions& options,
                        const ObservedDisplacements& observed,
                        AdaptiveFit& adaptive) {
  Estimate estimate;
  Stopwatch stopwatch;
  const bool is_regular = adaptive.Run(observed);
  estimate.stages.push_back({"fit", stopwatch.Lap()});
  if (!is_regular) {
    estimate.message =
        "the stiffness matrix is singular to working precision; check the "
        "mesh for slivers and loose parts, and the supports";
    estimate.why_no_standard_error = "there is no estimate";
    return estimate;
  }
  const ModelFit& best = adaptive.Best();
  estimate.elasticity = IsotropicElasticity::FromComplianceScale(
      best.point.compliance_scale, best.point.poisson_ratio);
  if (!estimate.elasticity.IsPhysical() ||
      !std::isfinite(estimate.elasticity.youngs_modulus)) {
    estimate.Fail(Status::kUnphysical, kDisplacementsOpposeLoads,
                  "the estimate is not physical");
    return estimate;
  }
  if (adaptive.HasConverged()) {
    estimate.status = Status::kOk;
    estimate.message = "";
  } else {
    estimate.status = Status::kIterationLimit;
    estimate.message =
        "the reduced model did not reach its accuracy; use iterative-fe";
  }
  const BoundedParameter poisson_ratio =
      options.known_poisson_ratio
          ? BoundedParameter::Constant(*options.known_poisson_ratio)
          : BoundedParameter(best.point.poisson_ratio,
                             adaptive.PoissonRatioBounds());
  const ActiveBounds active = NoteActiveBounds(
      options,
      BoundOf(options.youngs_modulus, estimate.elasticity.youngs_modulus),
      poisson_ratio, estimate);
  const std::optional<double> variance = DescribeDisplacementFit(
      scene, adaptive.Model().Graph(), options, observed,
      ExpandFit(adaptive.Model(), observed, estimate.elasticity), best.losses,
      active, estimate);
  if (variance && options.loss == Loss::kNone && estimate.IsUsable() &&
      (active.is_physical_limit ||
       ShareOfDistanceToPole(estimate) > kLargestLinearShare)) {
    DescribeProfile(
        [&](double quantile) {
          return adaptive.ProfileEnds(observed, quantile * *variance);
        },
        estimate);
  }
  NoteSolver(adaptive.Model().Notice(), estimate);
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

std::string ReducedFe::WhyUnsupported(const Scene& scene,
                                      const EstimatorOptions& options) const {
  if (options.virtual_field_degree) {
    return "it has no virtual fields to take a degree; use virtual-fields";
  }
  return WhyNoDisplacementFit(scene);
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
    load_case.displacement.resize(3, 0);
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
    const std::vector<Eigen::Matrix3Xd>& displacements) {
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
  const std::vector<std::string> warnings = CheckMeasurements(scene);
  if (!state_->observed) {
    state_->observed = std::make_unique<ObservedDisplacements>(scene);
  } else {
    state_->observed->Remeasure(scene);
  }
  const Work before = state_->adaptive.Model().WorkDone();
  Estimate estimate = RunAdaptiveFit(scene, state_->options, *state_->observed,
                                     state_->adaptive);
  estimate.work = state_->adaptive.Model().WorkDone() - before;
  FinishEstimate(ReducedFe(), scene, state_->options, warnings, estimate);
  estimate.seconds = stopwatch.Lap();
  return estimate;
}

}  // namespace elastimate
