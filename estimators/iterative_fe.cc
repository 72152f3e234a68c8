#include "elastimate/estimators/iterative_fe.h"

#include <ceres/cost_function.h>
#include <ceres/evaluation_callback.h>
#include <ceres/loss_function.h>
#include <ceres/problem.h>
#include <ceres/solver.h>

#include <Eigen/LU>
#include <algorithm>
#include <array>
#include <chrono>
#include <cmath>
#include <memory>
#include <sstream>

#include "elastimate/core/forward_model.h"
#include "elastimate/core/loads.h"
#include "elastimate/estimators/bounded_parameter.h"
#include "elastimate/estimators/statistics.h"

namespace elastimate {
namespace {

// Where the fit looks for a start.  The sum of squares can have a minimum on
// either side of zero (a slender bar in bending does), and steps towards 1/2
// are short: one point each, the likeliest last, where its factorisation is
// still at hand for the first step.
constexpr double kStartPoissonRatios[] = {-0.5, 0.45, 0.3};
// Steps below this part of a standard error end the fit.
constexpr double kSmallestStep = 1e-2;
// Huber's and Cauchy's constants, in standard deviations.
constexpr double kHuber = 1.345;
constexpr double kCauchy = 2.385;
// The sine of the identifiability angle below which rounding decides: it comes
// from the square root of a difference, which has half the digits.
constexpr double kCollinear = 1e-6;

// The observed free components of one node in one load case.
struct ObservedNode {
  Eigen::Index load_case;
  int num_components;
  std::array<Eigen::Index, 3> dofs;  // 3 * node + component.
};

std::vector<ObservedNode> ObservedNodes(const Scene& scene) {
  std::vector<ObservedNode> nodes;
  for (std::size_t k = 0; k < scene.load_cases.size(); ++k) {
    for (Eigen::Index node = 0; node < scene.mesh.NumNodes(); ++node) {
      ObservedNode observed{Eigen::Index(k), 0, {}};
      for (int i = 0; i < 3; ++i) {
        if (!scene.supports.held(i, node) &&
            IsObserved(scene.load_cases[k], i, node)) {
          observed.dofs[observed.num_components++] = 3 * node + i;
        }
      }
      if (observed.num_components > 0) {
        nodes.push_back(observed);
      }
    }
  }
  return nodes;
}

// What the first parameter of the fit is; the second is nu.
enum class Scale {
  // ln of the norm of t w at the observed components.  Its valley in (scale,
  // nu) is straight where that of (ln E, nu) is curved, and the derivatives
  // with respect to the two are orthogonal without held displacements.
  kLogResponseNorm,
  // ln E, for fits with E on a bound.
  kLogYoungsModulus,
};

// The displacements of the model at the parameters that Ceres asks for, and
// their residuals against the measurement, weighted and normalised so that the
// measurement has norm 1.
class DisplacementResidual : public ceres::EvaluationCallback {
 public:
  DisplacementResidual(const Scene& scene, const EstimatorOptions& options)
      : model_(scene.mesh, scene.supports, AssembleLoadCases(scene)),
        nodes_(ObservedNodes(scene)),
        on_factorization_(options.on_factorization) {
    for (const LoadCase& load_case : scene.load_cases) {
      measured_.emplace_back(load_case.displacement.reshaped());
      weights_.push_back(1 / load_case.noise_sd.value_or(1));
    }
    double square_sum = 0;
    for (const ObservedNode& node : nodes_) {
      for (int i = 0; i < node.num_components; ++i) {
        const double q = Measured(node, i) * weights_[node.load_case];
        square_sum += q * q;
        ++num_residuals_;
      }
    }
    norm_ = std::sqrt(square_sum);
    for (double& weight : weights_) {
      weight /= norm_;
    }
  }

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
        displacement_ = model_.Displacement(Elasticity().youngs_modulus);
      }
    }
    if (evaluate_jacobians && is_valid_) {
      sensitivities_ = model_.Sensitivities(Elasticity().youngs_modulus);
      log_youngs_modulus_slope_ = LogYoungsModulusSlope();
    }
  }

  // At the parameters.  Precondition: the model is at their nu.
  IsotropicElasticity Elasticity() const {
    const double nu = poisson_ratio_->Value();
    if (scale_ == Scale::kLogYoungsModulus) {
      return {std::exp(scale_parameter_->Value()), nu};
    }
    return IsotropicElasticity::FromComplianceScale(
        std::exp(scale_parameter_->Value()) / ResponseNorm(), nu);
  }

  // ||w|| at the observed components, weighted.
  double ResponseNorm() const {
    return std::sqrt(
        WeightedDot(model_.UnitLoadResponse(), model_.UnitLoadResponse()));
  }

  bool SetPoissonRatio(double poisson_ratio) {
    if (on_factorization_ && poisson_ratio != model_.PoissonRatio()) {
      on_factorization_(model_.WorkDone().factorizations + 1);
    }
    return model_.SetPoissonRatio(poisson_ratio);
  }

  struct ComplianceFit {
    double compliance_scale;
    double square_sum;
  };
  // The t that fits the measurement best at the model's nu.
  ComplianceFit FitComplianceScale() const {
    double numerator = 0;
    double denominator = 0;
    double rest_square_sum = 0;
    for (const ObservedNode& node : nodes_) {
      for (int i = 0; i < node.num_components; ++i) {
        const Eigen::Index dof = node.dofs[i];
        const double weight = weights_[node.load_case];
        const double w =
            weight * model_.UnitLoadResponse()(dof, node.load_case);
        const double rest =
            weight * (Measured(node, i) - model_.SupportResponse()(dof));
        numerator += w * rest;
        denominator += w * w;
        rest_square_sum += rest * rest;
      }
    }
    const double t = numerator / denominator;
    return {t, rest_square_sum - t * numerator};
  }

  bool IsValid() const { return is_valid_; }
  const std::vector<ObservedNode>& Nodes() const { return nodes_; }
  Eigen::Index NumResiduals() const { return num_residuals_; }
  /// The norm of the weighted measurement.
  double Norm() const { return norm_; }
  const Work& WorkDone() const { return model_.WorkDone(); }

  // Derivatives with respect to the two parameters of the fit.
  double ScaleDerivative(const ObservedNode& node, int i) const {
    const double derivative = LogYoungsModulusDerivative(node, i);
    return scale_ == Scale::kLogYoungsModulus ? derivative : -derivative;
  }
  double PoissonRatioDerivativeAtScale(const ObservedNode& node, int i) const {
    return PoissonRatioDerivative(node, i) +
           log_youngs_modulus_slope_ * LogYoungsModulusDerivative(node, i);
  }

  double Residual(const ObservedNode& node, int i) const {
    return weights_[node.load_case] *
           (displacement_(node.dofs[i], node.load_case) - Measured(node, i));
  }
  double LogYoungsModulusDerivative(const ObservedNode& node, int i) const {
    return weights_[node.load_case] *
           sensitivities_.log_youngs_modulus(node.dofs[i], node.load_case);
  }
  double PoissonRatioDerivative(const ObservedNode& node, int i) const {
    return weights_[node.load_case] *
           sensitivities_.poisson_ratio(node.dofs[i], node.load_case);
  }

 private:
  double Measured(const ObservedNode& node, int i) const {
    return measured_[node.load_case](node.dofs[i]);
  }

  // d ln E / d nu at fixed scale.
  double LogYoungsModulusSlope() const {
    if (scale_ == Scale::kLogYoungsModulus) {
      return 0;
    }
    const double nu = poisson_ratio_->Value();
    const Eigen::MatrixXd& w = model_.UnitLoadResponse();
    return 1 / (1 + nu) - 2 / (1 - 2 * nu) +
           WeightedDot(w, model_.UnitLoadResponseDerivative()) /
               WeightedDot(w, w);
  }

  double WeightedDot(const Eigen::MatrixXd& a, const Eigen::MatrixXd& b) const {
    double sum = 0;
    for (const ObservedNode& node : nodes_) {
      const double weight = weights_[node.load_case];
      for (int i = 0; i < node.num_components; ++i) {
        sum += weight * weight * a(node.dofs[i], node.load_case) *
               b(node.dofs[i], node.load_case);
      }
    }
    return sum;
  }

  ForwardModel model_;
  std::vector<ObservedNode> nodes_;
  std::function<void(int)> on_factorization_;
  std::vector<Eigen::VectorXd> measured_;
  std::vector<double> weights_;
  Eigen::Index num_residuals_ = 0;
  double norm_ = 0;
  Scale scale_ = Scale::kLogResponseNorm;
  const BoundedParameter* scale_parameter_ = nullptr;
  const BoundedParameter* poisson_ratio_ = nullptr;
  double log_youngs_modulus_slope_ = 0;
  bool is_valid_ = false;
  Eigen::MatrixXd displacement_;
  DisplacementSensitivities sensitivities_;
};

// The residuals of one node, looked up in the evaluation that all share.
class NodeCost : public ceres::CostFunction {
 public:
  NodeCost(const DisplacementResidual& residual, const ObservedNode& node)
      : residual_(residual), node_(node) {
    set_num_residuals(node.num_components);
    *mutable_parameter_block_sizes() = {1, 1};
  }

  bool Evaluate(double const* const* /*parameters*/, double* residuals,
                double** jacobians) const override {
    if (!residual_.IsValid()) {
      return false;
    }
    for (int i = 0; i < node_.num_components; ++i) {
      residuals[i] = residual_.Residual(node_, i);
      if (jacobians != nullptr && jacobians[0] != nullptr) {
        jacobians[0][i] = residual_.ScaleDerivative(node_, i);
      }
      if (jacobians != nullptr && jacobians[1] != nullptr) {
        jacobians[1][i] = residual_.PoissonRatioDerivativeAtScale(node_, i);
      }
    }
    return true;
  }

 private:
  const DisplacementResidual& residual_;
  const ObservedNode& node_;
};

// One loss for nodes of one, two and three observed components; null entries
// are least squares.
using NodeLosses = std::array<std::unique_ptr<ceres::LossFunction>, 3>;

// The norm of n residuals is sqrt(n) standard deviations in the mean.
NodeLosses MakeLosses(Loss loss, double residual_sd) {
  NodeLosses losses;
  for (int n = 1; n <= 3; ++n) {
    const double scale = std::sqrt(n) * residual_sd;
    if (loss == Loss::kHuber) {
      losses[n - 1] = std::make_unique<ceres::HuberLoss>(kHuber * scale);
    } else if (loss == Loss::kCauchy) {
      losses[n - 1] = std::make_unique<ceres::CauchyLoss>(kCauchy * scale);
    }
  }
  return losses;
}

ceres::Solver::Summary Minimize(DisplacementResidual& residual,
                                const NodeLosses& losses, int max_iterations,
                                BoundedParameter& scale,
                                BoundedParameter& poisson_ratio) {
  ceres::Problem::Options problem_options;
  problem_options.evaluation_callback = &residual;
  problem_options.loss_function_ownership = ceres::DO_NOT_TAKE_OWNERSHIP;
  ceres::Problem problem(problem_options);
  for (const ObservedNode& node : residual.Nodes()) {
    problem.AddResidualBlock(new NodeCost(residual, node),
                             losses[node.num_components - 1].get(),
                             scale.Block(), poisson_ratio.Block());
  }

  ceres::Solver::Options options;
  options.linear_solver_type = ceres::DENSE_QR;
  options.max_num_iterations = max_iterations;
  // The residual is normalised and the problem nearly linear: start with
  // Gauss-Newton steps.
  options.initial_trust_region_radius = 1e8;
  // A step of k standard errors lowers the cost by about k^2 / m of itself.
  options.function_tolerance = kSmallestStep * kSmallestStep /
                               static_cast<double>(residual.NumResiduals());
  options.gradient_tolerance = 1e-12;
  options.parameter_tolerance = 1e-9;
  options.logging_type = ceres::SILENT;
  return MinimizeWithinBounds(options, {&scale, &poisson_ratio}, problem);
}

// 1.4826 MAD of the residuals, which is their standard deviation when they are
// Gaussian.
double RobustResidualSd(const DisplacementResidual& residual) {
  std::vector<double> magnitudes;
  magnitudes.reserve(residual.NumResiduals());
  for (const ObservedNode& node : residual.Nodes()) {
    for (int i = 0; i < node.num_components; ++i) {
      magnitudes.push_back(std::abs(residual.Residual(node, i)));
    }
  }
  return 1.4826 * Median(std::move(magnitudes));
}

// Sums over the observed nodes that the statistics are made of.  Derivatives
// are with respect to (ln E, nu); without a loss the bread is S^T S.
struct ResidualSums {
  double square_sum = 0;
  Eigen::Matrix2d sensitivity_gram = Eigen::Matrix2d::Zero();
  Eigen::Matrix2d bread = Eigen::Matrix2d::Zero();
  Eigen::Matrix2d meat = Eigen::Matrix2d::Zero();
};

ResidualSums SumResiduals(const DisplacementResidual& residual,
                          const NodeLosses& losses) {
  ResidualSums sums;
  for (const ObservedNode& node : residual.Nodes()) {
    const int n = node.num_components;
    Eigen::Vector3d r = Eigen::Vector3d::Zero();
    Eigen::Matrix<double, 3, 2> s = Eigen::Matrix<double, 3, 2>::Zero();
    for (int i = 0; i < n; ++i) {
      r(i) = residual.Residual(node, i);
      s(i, 0) = residual.LogYoungsModulusDerivative(node, i);
      s(i, 1) = residual.PoissonRatioDerivative(node, i);
    }
    double rho[3] = {r.squaredNorm(), 1, 0};
    if (losses[n - 1] != nullptr) {
      losses[n - 1]->Evaluate(r.squaredNorm(), rho);
    }
    const Eigen::Vector2d gradient = s.transpose() * r;
    const Eigen::Matrix2d gram = s.transpose() * s;
    sums.square_sum += r.squaredNorm();
    sums.sensitivity_gram += gram;
    sums.bread += rho[1] * gram + 2 * rho[2] * gradient * gradient.transpose();
    sums.meat += rho[1] * rho[1] * gradient * gradient.transpose();
  }
  return sums;
}

double IdentifiabilityAngle(const Eigen::Matrix2d& gram) {
  const double cosine_product = std::abs(gram(0, 1));
  const double sine_product = std::sqrt(std::max(0.0, gram.determinant()));
  return std::atan2(sine_product, cosine_product);
}

// Variance of the normalised residuals: from the residuals themselves, or as
// given when they do not contradict it.
std::optional<double> ResidualVariance(const DisplacementResidual& residual,
                                       const Scene& scene, double square_sum,
                                       Eigen::Index num_free,
                                       Estimate& estimate) {
  const Eigen::Index redundancy = residual.NumResiduals() - num_free;
  const double norm_squared = residual.Norm() * residual.Norm();
  const std::optional<double>& given = scene.load_cases.front().noise_sd;
  if (redundancy <= 0 && !given) {
    estimate.why_no_standard_error =
        "there are no more measured components than unknowns, so that the "
        "noise cannot be estimated; give its standard deviation";
    return std::nullopt;
  }
  const double m = static_cast<double>(std::max<Eigen::Index>(redundancy, 1));
  const double variance = square_sum / m;
  estimate.noise_sd = given ? *given : std::sqrt(variance) * residual.Norm();
  if (!given) {
    return variance;
  }
  // chi^2 has mean m and variance 2 m.
  const double ratio = variance * norm_squared;
  if (redundancy > 0 && ratio > 1 + 5 * std::sqrt(2 / m)) {
    std::ostringstream text;
    text.precision(2);
    text << "the displacement residual is " << std::sqrt(ratio)
         << " times the given noise, and the standard errors are widened to "
            "match; the mesh, the supports or the loads do not describe the "
            "experiment";
    estimate.warnings.push_back(text.str());
    return variance;
  }
  return 1 / norm_squared;
}

void Describe(const DisplacementResidual& residual, const Scene& scene,
              const NodeLosses& losses, const ActiveBounds& active,
              bool poisson_ratio_is_known, Estimate& estimate) {
  const ResidualSums sums = SumResiduals(residual, losses);
  estimate.displacement_residual = std::sqrt(sums.square_sum);
  estimate.identifiability_angle = IdentifiabilityAngle(sums.sensitivity_gram);
  std::vector<Eigen::Index> free;
  if (active.youngs_modulus == BoundedParameter::Side::kNone) {
    free.push_back(0);
  }
  if (!poisson_ratio_is_known &&
      active.poisson_ratio == BoundedParameter::Side::kNone) {
    free.push_back(1);
  }
  if (free.size() == 2 &&
      std::sin(*estimate.identifiability_angle) < kCollinear) {
    estimate.status = Status::kNotIdentifiable;
    estimate.message = DescribeCollinear(
        estimate.elasticity,
        {-sums.sensitivity_gram(0, 1) / sums.sensitivity_gram(0, 0), 1});
    estimate.elasticity = {Estimate::kUnknown, Estimate::kUnknown};
    estimate.why_no_standard_error = "the parameters are not determined";
    return;
  }
  const bool has_loss = losses[0] != nullptr;
  Eigen::Matrix2d covariance = Eigen::Matrix2d::Constant(Estimate::kUnknown);
  const Eigen::MatrixXd inverse_bread =
      Eigen::MatrixXd(sums.bread(free, free)).inverse();
  if (has_loss) {
    estimate.noise_sd = RobustResidualSd(residual) * residual.Norm();
    covariance(free, free) =
        inverse_bread * sums.meat(free, free) * inverse_bread;
  } else {
    const std::optional<double> variance = ResidualVariance(
        residual, scene, sums.square_sum, Eigen::Index(free.size()), estimate);
    if (!variance) {
      return;
    }
    covariance(free, free) = *variance * inverse_bread;
  }
  const Eigen::Vector2d scale(estimate.elasticity.youngs_modulus, 1);
  estimate.covariance = scale.asDiagonal() * covariance * scale.asDiagonal();
  if (!estimate.active_bounds.empty()) {
    estimate.why_no_standard_error = "a parameter on a bound has none";
  }
}

// Fits, with the scale of the loss from the residuals of the fit before.
ceres::Solver::Summary Fit(const EstimatorOptions& options,
                           DisplacementResidual& residual,
                           BoundedParameter& scale_parameter,
                           BoundedParameter& poisson_ratio,
                           NodeLosses& losses) {
  constexpr int kMaxRescalings = 5;
  constexpr double kScaleTolerance = 0.01;
  constexpr double kExactFit = 1e-12;
  ceres::Solver::Summary summary = Minimize(
      residual, losses, options.max_iterations, scale_parameter, poisson_ratio);
  if (options.loss == Loss::kNone) {
    return summary;
  }
  double scale = 0;
  for (int i = 0; i < kMaxRescalings && summary.IsSolutionUsable(); ++i) {
    residual.PrepareForEvaluation(true, true);
    const double new_scale = RobustResidualSd(residual);
    if (std::abs(new_scale - scale) <= kScaleTolerance * new_scale ||
        new_scale < kExactFit) {
      break;
    }
    scale = new_scale;
    losses = MakeLosses(options.loss, scale);
    summary = Minimize(residual, losses, options.max_iterations,
                       scale_parameter, poisson_ratio);
  }
  return summary;
}

// The best of the start points within the bounds, with the E that fits best
// there.  Empty when the stiffness is singular at all of them; E is not
// positive when it is at none of them.
std::optional<IsotropicElasticity> FindStart(const EstimatorOptions& options,
                                             DisplacementResidual& residual) {
  std::vector<double> candidates;
  if (options.known_poisson_ratio) {
    candidates = {*options.known_poisson_ratio};
  } else {
    const Bounds bounds = EffectivePoissonRatioBounds(options);
    for (const double nu : kStartPoissonRatios) {
      candidates.push_back(std::clamp(nu, *bounds.lower, *bounds.upper));
    }
    candidates.erase(std::unique(candidates.begin(), candidates.end()),
                     candidates.end());
  }
  std::optional<IsotropicElasticity> best;
  double best_square_sum = 0;
  for (const double nu : candidates) {
    if (!residual.SetPoissonRatio(nu)) {
      continue;
    }
    const auto fit = residual.FitComplianceScale();
    const IsotropicElasticity elasticity =
        IsotropicElasticity::FromComplianceScale(fit.compliance_scale, nu);
    const bool is_better =
        !best || (elasticity.IsPhysical() &&
                  (!best->IsPhysical() || fit.square_sum <= best_square_sum));
    if (is_better) {
      best = elasticity;
      best_square_sum = fit.square_sum;
    }
  }
  return best;
}

BoundedParameter::Side ViolatedBound(const Bounds& bounds,
                                     const IsotropicElasticity& elasticity) {
  if (elasticity.youngs_modulus < bounds.lower.value_or(0)) {
    return BoundedParameter::Side::kLower;
  }
  if (bounds.upper && elasticity.youngs_modulus > *bounds.upper) {
    return BoundedParameter::Side::kUpper;
  }
  return BoundedParameter::Side::kNone;
}

class Stopwatch {
 public:
  double Lap() {
    const auto now = std::chrono::steady_clock::now();
    const double seconds = std::chrono::duration<double>(now - last_).count();
    last_ = now;
    return seconds;
  }

 private:
  std::chrono::steady_clock::time_point last_ =
      std::chrono::steady_clock::now();
};

}  // namespace

std::string_view IterativeFe::Name() const { return "iterative-fe"; }

std::string_view IterativeFe::Description() const {
  return "maximum likelihood fit of the displacements, a finite element "
         "solution at each step; unbiased, costs factorisations (reference)";
}

std::string IterativeFe::WhyUnsupported(
    const Scene& scene, const EstimatorOptions& /*options*/) const {
  const std::string why_not_held = WhyNotHeld(scene.mesh, scene.supports);
  return why_not_held.empty()
             ? ""
             : why_not_held + ", or use closed-form, which needs no supports";
}

Estimate IterativeFe::DoRun(const Scene& scene,
                            const EstimatorOptions& options) const {
  Estimate estimate;
  Stopwatch stopwatch;
  DisplacementResidual residual(scene, options);
  estimate.stages.push_back({"assemble and analyse", stopwatch.Lap()});

  const std::optional<IsotropicElasticity> start = FindStart(options, residual);
  if (!start) {
    estimate.message =
        "the stiffness matrix is singular to working precision; check the "
        "mesh for slivers and loose parts, and the supports";
    estimate.why_no_standard_error = "there is no estimate";
    estimate.work = residual.WorkDone();
    return estimate;
  }
  if (!start->IsPhysical() || !std::isfinite(start->youngs_modulus)) {
    estimate.status = Status::kUnphysical;
    estimate.elasticity = *start;
    estimate.message =
        "the measured displacements oppose the loads; check their signs, "
        "order and units";
    estimate.why_no_standard_error = "the estimate is not physical";
    estimate.work = residual.WorkDone();
    return estimate;
  }

  residual.SetPoissonRatio(start->poisson_ratio);
  BoundedParameter scale(
      std::log(start->ComplianceScale() * residual.ResponseNorm()), Bounds{});
  BoundedParameter poisson_ratio =
      options.known_poisson_ratio
          ? BoundedParameter::Constant(*options.known_poisson_ratio)
          : BoundedParameter(start->poisson_ratio,
                             EffectivePoissonRatioBounds(options));
  residual.SetParameters(Scale::kLogResponseNorm, &scale, &poisson_ratio);
  NodeLosses losses;
  ceres::Solver::Summary summary =
      Fit(options, residual, scale, poisson_ratio, losses);
  residual.PrepareForEvaluation(true, true);

  // A minimum beyond a bound on E has the bounded one on that bound.
  const BoundedParameter::Side violated =
      ViolatedBound(options.youngs_modulus, residual.Elasticity());
  if (violated != BoundedParameter::Side::kNone) {
    scale = BoundedParameter::Constant(
        std::log(violated == BoundedParameter::Side::kLower
                     ? *options.youngs_modulus.lower
                     : *options.youngs_modulus.upper));
    residual.SetParameters(Scale::kLogYoungsModulus, &scale, &poisson_ratio);
    summary = Fit(options, residual, scale, poisson_ratio, losses);
    residual.PrepareForEvaluation(true, true);
  }
  estimate.stages.push_back({"fit", stopwatch.Lap()});
  estimate.elasticity = residual.Elasticity();
  const ActiveBounds active =
      NoteActiveBounds(options, violated, poisson_ratio, estimate);
  if (summary.termination_type == ceres::CONVERGENCE) {
    estimate.status = Status::kOk;
    estimate.message = "";
  } else if (summary.termination_type == ceres::NO_CONVERGENCE) {
    estimate.status = Status::kIterationLimit;
    estimate.message = "the fit did not converge in " +
                       std::to_string(options.max_iterations) + " iterations";
  } else {
    estimate.message = summary.message;
  }
  if (residual.IsValid()) {
    Describe(residual, scene, losses, active,
             options.known_poisson_ratio.has_value(), estimate);
  }
  estimate.stages.push_back({"statistics", stopwatch.Lap()});
  estimate.work = residual.WorkDone();
  return estimate;
}

}  // namespace elastimate
