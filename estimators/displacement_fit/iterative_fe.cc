#include "elastimate/estimators/displacement_fit/iterative_fe.h"

#include <ceres/cost_function.h>
#include <ceres/evaluation_callback.h>
#include <ceres/problem.h>
#include <ceres/solver.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <iterator>
#include <limits>
#include <optional>
#include <utility>
#include <vector>

#include "elastimate/core/equilibrium/forward_model.h"
#include "elastimate/core/scene/loads.h"
#include "elastimate/core/scene/observed_displacements.h"
#include "elastimate/estimators/displacement_fit/displacement_fit.h"
#include "elastimate/estimators/displacement_fit/element_change.h"
#include "elastimate/estimators/displacement_fit/material_fit.h"
#include "elastimate/estimators/displacement_fit/node_losses.h"
#include "elastimate/estimators/force_balance/virtual_fields.h"
#include "elastimate/estimators/interface/judge.h"
#include "elastimate/estimators/interface/statistics.h"
#include "elastimate/estimators/interface/stopwatch.h"
#include "elastimate/estimators/statistics/bounded_parameter.h"
#include "elastimate/estimators/statistics/profile_likelihood.h"

namespace elastimate {
namespace {

// Where the fit looks for a start, besides virtual-fields: in each decade of
// (1 + nu) / (1 - 2 nu), the scale on which the stiffness changes evenly, since
// the sum of squares can have several minima (that of a slender bar or a plate
// in bending has).
constexpr double kStartPoissonRatios[] = {-0.85, -0.5, 0.0,   0.3,
                                          0.45,  0.48, 0.495, 0.499};
// Steps below this part of a standard error end the fit.
constexpr double kSmallestStep = 1e-2;

// What the first parameter of the fit is; the second is nu.
enum class Scale {
  // ln of the norm of t w at the observed components.  Its valley in (scale,
  // nu) is straight where that of (ln E, nu) is curved, and the derivatives
  // with respect to the two are orthogonal without held displacements.
  kLogResponseNorm,
  // ln E, for fits with E on a bound.
  kLogYoungsModulus,
};

// The residual of the displacements at the parameters that Ceres asks for.
class DisplacementResidual : public ceres::EvaluationCallback {
 public:
  DisplacementResidual(const Scene& scene, const EstimatorOptions& options)
      : section_model_(scene.mesh.section.model),
        model_(scene.mesh, scene.supports, AssembleLoadCases(scene),
               options.solver),
        num_load_cases_(Eigen::Index(scene.load_cases.size())),
        observed_(scene),
        change_(scene),
        on_factorization_(options.on_factorization) {}

  // The parameters that evaluations are asked for at.
  void SetParameters(Scale scale, const BoundedParameter* scale_parameter,
                     const BoundedParameter* poisson_ratio) {
    scale_ = scale;
    scale_parameter_ = scale_parameter;
    poisson_ratio_ = poisson_ratio;
  }

  void PrepareForEvaluation(bool evaluate_jacobians,
                            bool new_evaluation_point) override {
    if (new_evaluation_point) {
      is_valid_ = SetPoissonRatio(poisson_ratio_->Value());
      if (is_valid_) {
        fit_.displacement = model_.Displacement(Elasticity().youngs_modulus);
        fit_.residual =
            observed_.Restrict(fit_.displacement) - observed_.Measured();
      }
    }
    if (evaluate_jacobians && is_valid_) {
      const DisplacementSensitivities sensitivities =
          model_.Sensitivities(Elasticity().youngs_modulus);
      fit_.sensitivities.resize(observed_.Size(), 2);
      fit_.sensitivities << observed_.Restrict(
          sensitivities.log_youngs_modulus),
          observed_.Restrict(sensitivities.poisson_ratio);
      const double sign = scale_ == Scale::kLogYoungsModulus ? 1 : -1;
      jacobian_.resize(observed_.Size(), 2);
      jacobian_ << sign * fit_.sensitivities.col(0),
          fit_.sensitivities.col(1) +
              SlopeAtFixedScale() * fit_.sensitivities.col(0);
    }
  }

  bool SetPoissonRatio(double poisson_ratio) {
    if (poisson_ratio == model_.PoissonRatio()) {
      return true;
    }
    if (on_factorization_) {
      on_factorization_(++num_factorizations_);
    }
    if (!model_.SetPoissonRatio(poisson_ratio)) {
      return false;
    }
    unit_load_response_ = observed_.Restrict(model_.UnitLoadResponse());
    return true;
  }

  // At the parameters.  Precondition: the model is at their nu.
  IsotropicElasticity Elasticity() const {
    const double nu = poisson_ratio_->Value();
    if (scale_ == Scale::kLogYoungsModulus) {
      return {std::exp(scale_parameter_->Value()), nu};
    }
    return IsotropicElasticity::FromComplianceScale(
        std::exp(scale_parameter_->Value()) / unit_load_response_.norm(), nu,
        section_model_);
  }

  // Adds what the elements miss to the fit.
  void FindElementChange() {
    fit_.element_change =
        change_.Rows(observed_, Elasticity(), model_.Responses(),
                     [this](double /*nu*/) { return &model_.Solver(); });
  }

  // The rows of w and of v at the nu of the model.
  const Eigen::VectorXd& UnitLoadResponse() const {
    return unit_load_response_;
  }
  Eigen::VectorXd SupportResponse() const {
    return observed_.Restrict(
        model_.SupportResponse().replicate(1, num_load_cases_));
  }

  // The rows of du/dnu at the nu of the model: at fixed E, or else at fixed t.
  Eigen::VectorXd PoissonRatioSlope(const IsotropicElasticity& elasticity,
                                    bool at_fixed_youngs_modulus) {
    const double nu = elasticity.poisson_ratio;
    const DisplacementSensitivities sensitivities =
        model_.Sensitivities(elasticity.youngs_modulus);
    const double log_youngs_modulus_slope =
        at_fixed_youngs_modulus ? 0 : LogYoungsModulusSlope(nu, section_model_);
    return observed_.Restrict(sensitivities.poisson_ratio) +
           log_youngs_modulus_slope *
               observed_.Restrict(sensitivities.log_youngs_modulus);
  }

  bool IsValid() const { return is_valid_; }
  SectionModel Section() const { return section_model_; }
  const ObservedDisplacements& Observed() const { return observed_; }
  /// At the last evaluation, with derivatives by (ln E, nu).
  const DisplacementFit& Fit() const { return fit_; }
  /// Derivatives of the residual by the two parameters of the fit.
  const Eigen::Matrix<double, Eigen::Dynamic, 2>& Jacobian() const {
    return jacobian_;
  }
  const NodeGraph& Graph() const { return model_.Graph(); }
  Work WorkDone() const { return model_.WorkDone() + change_.WorkDone(); }
  const std::string& SolverNotice() const { return model_.Notice(); }

 private:
  // d ln E / d nu at fixed scale.
  double SlopeAtFixedScale() const {
    if (scale_ == Scale::kLogYoungsModulus) {
      return 0;
    }
    const double nu = poisson_ratio_->Value();
    return LogYoungsModulusSlope(nu, section_model_) +
           unit_load_response_.dot(
               observed_.Restrict(model_.UnitLoadResponseDerivative())) /
               unit_load_response_.squaredNorm();
  }

  SectionModel section_model_;
  ForwardModel model_;
  Eigen::Index num_load_cases_;
  ObservedDisplacements observed_;
  ElementChange change_;
  std::function<void(int)> on_factorization_;
  int num_factorizations_ = 0;
  Scale scale_ = Scale::kLogResponseNorm;
  const BoundedParameter* scale_parameter_ = nullptr;
  const BoundedParameter* poisson_ratio_ = nullptr;
  bool is_valid_ = false;
  Eigen::VectorXd unit_load_response_;
  DisplacementFit fit_;
  Eigen::Matrix<double, Eigen::Dynamic, 2> jacobian_;
};

// The residuals of one node, looked up in the evaluation that all share.
class NodeCost : public ceres::CostFunction {
 public:
  NodeCost(const DisplacementResidual& residual,
           const ObservedDisplacements::Point& node)
      : residual_(residual), node_(node) {
    set_num_residuals(node.count);
    *mutable_parameter_block_sizes() = {1, 1};
  }

  bool Evaluate(double const* const* /*parameters*/, double* residuals,
                double** jacobians) const override {
    if (!residual_.IsValid()) {
      return false;
    }
    for (int i = 0; i < node_.count; ++i) {
      const Eigen::Index row = node_.first + i;
      residuals[i] = residual_.Fit().residual(row);
      for (int parameter = 0; parameter < 2; ++parameter) {
        if (jacobians != nullptr && jacobians[parameter] != nullptr) {
          jacobians[parameter][i] = residual_.Jacobian()(row, parameter);
        }
      }
    }
    return true;
  }

 private:
  const DisplacementResidual& residual_;
  const ObservedDisplacements::Point& node_;
};

ceres::Solver::Summary Minimize(DisplacementResidual& residual,
                                const NodeLosses& losses, int max_iterations,
                                BoundedParameter& scale,
                                BoundedParameter& poisson_ratio) {
  ceres::Problem::Options problem_options;
  problem_options.evaluation_callback = &residual;
  problem_options.loss_function_ownership = ceres::DO_NOT_TAKE_OWNERSHIP;
  ceres::Problem problem(problem_options);
  for (const ObservedDisplacements::Point& node :
       residual.Observed().Points()) {
    problem.AddResidualBlock(new NodeCost(residual, node),
                             losses.ForCount(node.count), scale.Block(),
                             poisson_ratio.Block());
  }

  ceres::Solver::Options options;
  options.linear_solver_type = ceres::DENSE_QR;
  options.max_num_iterations = max_iterations;
  // The residual is normalised and the problem nearly linear: start with
  // Gauss-Newton steps.
  options.initial_trust_region_radius = 1e8;
  // A step of k standard errors lowers the cost by about k^2 / m of itself.
  options.function_tolerance = kSmallestStep * kSmallestStep /
                               static_cast<double>(residual.Observed().Size());
  options.gradient_tolerance = 1e-12;
  options.parameter_tolerance = 1e-9;
  options.logging_type = ceres::SILENT;
  return MinimizeWithinBounds(options, {&scale, &poisson_ratio}, problem);
}

// Fits; with a loss, its scale comes from the residuals of the start, and then
// from those of the fit before.
ceres::Solver::Summary Fit(const EstimatorOptions& options,
                           DisplacementResidual& residual,
                           BoundedParameter& scale_parameter,
                           BoundedParameter& poisson_ratio,
                           NodeLosses& losses) {
  constexpr int kMaxRescalings = 5;
  constexpr double kScaleTolerance = 0.01;
  constexpr double kExactFit = 1e-12;
  if (options.loss == Loss::kNone) {
    return Minimize(residual, losses, options.max_iterations, scale_parameter,
                    poisson_ratio);
  }
  ceres::Solver::Summary summary;
  double scale = 0;
  for (int i = 0; i <= kMaxRescalings; ++i) {
    residual.PrepareForEvaluation(false, true);
    if (!residual.IsValid()) {
      break;
    }
    const double new_scale = RobustStandardDeviation(residual.Fit().residual);
    if (i > 0 && (std::abs(new_scale - scale) <= kScaleTolerance * new_scale ||
                  new_scale < kExactFit)) {
      break;
    }
    scale = std::max(new_scale, kExactFit);
    losses = NodeLosses(options.loss, scale);
    summary = Minimize(residual, losses, options.max_iterations,
                       scale_parameter, poisson_ratio);
    if (!summary.IsSolutionUsable()) {
      break;
    }
  }
  return summary;
}

// The best fit at one nu.
struct ProfilePoint {
  IsotropicElasticity elasticity;
  /// The sum of squares; with a loss that of absolute deviations, so that
  /// outliers do not choose the start.
  double cost;
  /// Its derivative by nu.
  double slope = 0;
  /// Without bounds on E.
  IsotropicElasticity unbounded = elasticity;
  double unbounded_cost = cost;
};

double CostOf(Loss loss, const Eigen::VectorXd& residual) {
  return loss == Loss::kNone ? residual.squaredNorm() : residual.lpNorm<1>();
}

// At the nu of the model, with the best E within its bounds.
ProfilePoint EvaluateProfile(const EstimatorOptions& options,
                             DisplacementResidual& residual, double nu) {
  const Eigen::VectorXd& w = residual.UnitLoadResponse();
  const Eigen::VectorXd rest =
      residual.Observed().Measured() - residual.SupportResponse();
  if (w.isZero(0)) {
    return {{Estimate::kUnknown, nu}, std::numeric_limits<double>::infinity()};
  }
  const double t = options.loss == Loss::kNone
                       ? w.dot(rest) / w.squaredNorm()
                       : LeastAbsoluteDeviations(w, rest);
  IsotropicElasticity elasticity =
      IsotropicElasticity::FromComplianceScale(t, nu, residual.Section());
  if (!elasticity.IsPhysical()) {
    return {elasticity, CostOf(options.loss, rest - t * w)};
  }
  const IsotropicElasticity unbounded = elasticity;
  double& youngs_modulus = elasticity.youngs_modulus;
  youngs_modulus = std::max(
      youngs_modulus, options.youngs_modulus.lower.value_or(youngs_modulus));
  youngs_modulus = std::min(
      youngs_modulus, options.youngs_modulus.upper.value_or(youngs_modulus));
  const Eigen::VectorXd misfit =
      elasticity.ComplianceScale(residual.Section()) * w - rest;
  const Eigen::VectorXd change = residual.PoissonRatioSlope(
      elasticity, youngs_modulus != unbounded.youngs_modulus);
  const double slope = options.loss == Loss::kNone
                           ? 2 * misfit.dot(change)
                           : misfit.cwiseSign().dot(change);
  return {elasticity, CostOf(options.loss, misfit), slope, unbounded,
          CostOf(options.loss, rest - t * w)};
}

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
                                         DisplacementResidual& residual) {
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
    if (residual.SetPoissonRatio(nu)) {
      starts.push_back(EvaluateProfile(options, residual, nu));
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

// The profile likelihood without bounds on E, as far as it has been evaluated:
// the starts, and the fit itself as the best.
class EvaluatedProfile {
 public:
  EvaluatedProfile(const std::vector<ProfilePoint>& points,
                   const ProfilePoint& best)
      : best_(best) {
    for (const ProfilePoint& point : points) {
      Add(point);
    }
  }

  void Add(const ProfilePoint& point) { points_.push_back(point); }

  // The outermost fit where, towards `limit`, the cost exceeds the least by
  // `excess`: between two points the root of what it exceeds by is taken as
  // linear, and so is E.  At the limit where the last point does not exceed it.
  IsotropicElasticity EndTowards(double limit, double excess) const {
    const double nu = best_.unbounded.poisson_ratio;
    std::vector<ProfilePoint> side = {best_};
    for (const ProfilePoint& point : points_) {
      if ((point.unbounded.poisson_ratio - nu) * (limit - nu) > 0) {
        side.push_back(point);
      }
    }
    std::sort(side.begin(), side.end(),
              [nu](const ProfilePoint& a, const ProfilePoint& b) {
                return std::abs(a.unbounded.poisson_ratio - nu) <
                       std::abs(b.unbounded.poisson_ratio - nu);
              });
    const auto root_of = [&](const ProfilePoint& point) {
      return std::sqrt(
          std::max(point.unbounded_cost - best_.unbounded_cost, 0.0) / excess);
    };
    std::size_t inner = side.size() - 1;
    while (root_of(side[inner]) >= 1) {
      --inner;  // The best is inside.
    }
    const IsotropicElasticity& inside = side[inner].unbounded;
    if (inner + 1 == side.size()) {
      return {inside.youngs_modulus, limit};
    }
    const IsotropicElasticity& outside = side[inner + 1].unbounded;
    const double inner_root = root_of(side[inner]);
    const double share =
        (1 - inner_root) / (root_of(side[inner + 1]) - inner_root);
    const auto between = [share](double a, double b) {
      return a + share * (b - a);
    };
    return {between(inside.youngs_modulus, outside.youngs_modulus),
            between(inside.poisson_ratio, outside.poisson_ratio)};
  }

 private:
  std::vector<ProfilePoint> points_;
  ProfilePoint best_;
};

Side ViolatedBound(const Bounds& bounds,
                   const IsotropicElasticity& elasticity) {
  if (elasticity.youngs_modulus < bounds.lower.value_or(0)) {
    return Side::kLower;
  }
  if (bounds.upper && elasticity.youngs_modulus > *bounds.upper) {
    return Side::kUpper;
  }
  return Side::kNone;
}

// A minimum of the cost.
struct Minimum {
  BoundedParameter scale;
  BoundedParameter poisson_ratio;
  Scale meaning;
  Side violated;
  NodeLosses losses;
  ceres::Solver::Summary summary;
  double cost;
};

// The minimum that is reached from a start, with E free or on a bound.
Minimum DescendWith(Side side, const EstimatorOptions& options,
                    const IsotropicElasticity& start,
                    DisplacementResidual& residual) {
  residual.SetPoissonRatio(start.poisson_ratio);
  const bool is_free = side == Side::kNone;
  const double scale = is_free ? start.ComplianceScale(residual.Section()) *
                                     residual.UnitLoadResponse().norm()
                       : side == Side::kLower ? *options.youngs_modulus.lower
                                              : *options.youngs_modulus.upper;
  Minimum minimum = {
      is_free ? BoundedParameter(std::log(scale), Bounds{})
              : BoundedParameter::Constant(std::log(scale)),
      options.known_poisson_ratio
          ? BoundedParameter::Constant(*options.known_poisson_ratio)
          : BoundedParameter(start.poisson_ratio,
                             EffectivePoissonRatioBounds(options)),
      is_free ? Scale::kLogResponseNorm : Scale::kLogYoungsModulus,
      side,
      {},
      {},
      std::numeric_limits<double>::infinity()};
  residual.SetParameters(minimum.meaning, &minimum.scale,
                         &minimum.poisson_ratio);
  minimum.summary = Fit(options, residual, minimum.scale, minimum.poisson_ratio,
                        minimum.losses);
  residual.PrepareForEvaluation(false, true);
  if (residual.IsValid()) {
    minimum.cost = CostOf(options.loss, residual.Fit().residual);
  }
  return minimum;
}

// The minimum within the bounds on E that is reached from a start: where the
// one with a free E lies beyond a bound, that on the bound.
Minimum Descend(const EstimatorOptions& options,
                const IsotropicElasticity& start,
                DisplacementResidual& residual) {
  Minimum minimum = DescendWith(Side::kNone, options, start, residual);
  if (!residual.IsValid()) {
    return minimum;
  }
  const Side side =
      ViolatedBound(options.youngs_modulus, residual.Elasticity());
  if (side == Side::kNone) {
    return minimum;
  }
  // The bounded minimum may lie on either side of the two.
  const IsotropicElasticity unbounded = residual.Elasticity();
  minimum = DescendWith(side, options, start, residual);
  Minimum other = DescendWith(side, options, unbounded, residual);
  return other.cost < minimum.cost ? std::move(other) : std::move(minimum);
}

// The profile at the nu of a minimum; of infinite cost where it was not
// reached.
ProfilePoint PointOf(const Minimum& minimum, DisplacementResidual& residual,
                     const EstimatorOptions& options) {
  const double nu = minimum.poisson_ratio.Value();
  if (!std::isfinite(minimum.cost) || !residual.SetPoissonRatio(nu)) {
    return {{Estimate::kUnknown, nu}, std::numeric_limits<double>::infinity()};
  }
  return EvaluateProfile(options, residual, nu);
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
                       const std::vector<ProfilePoint>& points, double variance,
                       DisplacementResidual& residual, Evidence& evidence,
                       Estimate& estimate) {
  EvaluatedProfile profile(
      points, {estimate.elasticity, residual.Fit().residual.squaredNorm()});
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
          profile.EndTowards(limit, kTwoSidedQuantile * variance).poisson_ratio;
      if (end != limit &&
          std::abs(end - last_end) < kSettled * std::abs(end - nu)) {
        break;
      }
      last_end = end;
      const double next = end != limit ? end : beyond;
      if (next != nu && residual.SetPoissonRatio(next)) {
        profile.Add(EvaluateProfile(options, residual, next));
      }
    }
  }
  evidence.profile_interval = DescribeProfile(
      [&](double quantile) {
        const double excess = quantile * variance;
        return Profile{profile.EndTowards(*bounds.lower, excess),
                       profile.EndTowards(*bounds.upper, excess)};
      },
      estimate);
}

// Fills in what follows from the fit.  `points` of the profile are for the
// interval of nu.
void DescribeFit(const Scene& scene, const EstimatorOptions& options,
                 const std::vector<ProfilePoint>& points,
                 const NodeLosses& losses, DisplacementResidual& residual,
                 Evidence& evidence, Estimate& estimate) {
  const std::optional<double> variance = DescribeDisplacementFit(
      scene, residual.Graph(), options, residual.Observed(), residual.Fit(),
      losses, evidence, estimate);
  Judge(evidence, options, estimate);
  if (!variance || options.loss != Loss::kNone || !estimate.IsUsable() ||
      evidence.active.youngs_modulus != Side::kNone) {
    return;
  }
  const double least = residual.Fit().residual.squaredNorm();
  const double nu = estimate.elasticity.poisson_ratio;
  const double far = 4 * estimate.PoissonRatioStandardError().value_or(0);
  const bool has_rival =
      std::any_of(points.begin(), points.end(), [&](const ProfilePoint& point) {
        return point.unbounded_cost <= least + kTwoSidedQuantile * *variance &&
               std::abs(point.unbounded.poisson_ratio - nu) > far;
      });
  if (evidence.active.is_physical_limit || has_rival ||
      ShareOfDistanceToPole(estimate) > kLargestLinearShare) {
    DescribeProfileOf(options, points, *variance, residual, evidence, estimate);
  }
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
  capabilities.takes_materials = true;
  return capabilities;
}

Estimate IterativeFe::DoRun(const Scene& scene,
                            const EstimatorOptions& options) const {
  if (!IsOneIsotropicMaterial(scene.materials)) {
    return FitMaterials(scene, options);
  }
  Estimate estimate;
  Evidence evidence;
  Stopwatch stopwatch;
  DisplacementResidual residual(scene, options);
  estimate.stages.push_back({"assemble and analyse", stopwatch.Lap()});

  std::vector<ProfilePoint> points = EvaluateStarts(scene, options, residual);
  const std::vector<IsotropicElasticity> basins = BasinsOf(points);
  if (basins.empty()) {
    if (points.empty()) {
      evidence.end = End::kSingularStiffness;
    } else {
      evidence.do_displacements_oppose_loads = true;
      estimate.elasticity = points.front().elasticity;
    }
    Judge(evidence, options, estimate);
    estimate.work = residual.WorkDone();
    return estimate;
  }
  const Minimum best = BestMinimum(options, basins, residual, points);
  residual.SetParameters(best.meaning, &best.scale, &best.poisson_ratio);
  residual.PrepareForEvaluation(true, true);
  estimate.stages.push_back({"fit", stopwatch.Lap()});
  evidence.end = EndOf(best.summary);
  evidence.search_message = "Ceres: " + best.summary.message;
  if (residual.IsValid()) {
    estimate.elasticity = residual.Elasticity();
    evidence.active =
        NoteActiveBounds(options, best.violated, best.poisson_ratio, estimate);
    residual.FindElementChange();
    DescribeFit(scene, options, points, best.losses, residual, evidence,
                estimate);
  }
  evidence.solver_notice = residual.SolverNotice();
  Judge(evidence, options, estimate);
  CorrectForElements(evidence, estimate);
  estimate.stages.push_back({"statistics", stopwatch.Lap()});
  estimate.work = residual.WorkDone();
  return estimate;
}

}  // namespace elastimate
