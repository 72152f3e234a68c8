#include "elastimate/estimators/displacement_fit/displacement_minimum.h"

#include <ceres/cost_function.h>
#include <ceres/problem.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "elastimate/core/algebra/node_sums.h"
#include "elastimate/estimators/displacement_fit/displacement_profile.h"
#include "elastimate/estimators/interface/judge.h"
#include "elastimate/estimators/interface/statistics.h"

namespace elastimate {
namespace {

// Steps below this part of a standard error end the fit.
constexpr double kSmallestStep = 1e-2;

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
       residual.Model().Observed().Points()) {
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
  options.function_tolerance =
      kSmallestStep * kSmallestStep /
      static_cast<double>(residual.Model().Observed().Size());
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

// The minimum that is reached from a start, with E free or on a bound.
Minimum DescendWith(Side side, const EstimatorOptions& options,
                    const IsotropicElasticity& start,
                    DisplacementResidual& residual) {
  residual.Model().SetPoissonRatio(start.poisson_ratio);
  const bool is_free = side == Side::kNone;
  const double scale = is_free
                           ? start.ComplianceScale(residual.Model().Section()) *
                                 Norm(residual.Model().UnitLoadResponse())
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

}  // namespace

void DisplacementResidual::SetParameters(
    Scale scale, const BoundedParameter* scale_parameter,
    const BoundedParameter* poisson_ratio) {
  scale_ = scale;
  scale_parameter_ = scale_parameter;
  poisson_ratio_ = poisson_ratio;
}

void DisplacementResidual::PrepareForEvaluation(bool evaluate_jacobians,
                                                bool new_evaluation_point) {
  const ObservedDisplacements& observed = model_.Observed();
  if (new_evaluation_point) {
    is_valid_ = model_.SetPoissonRatio(poisson_ratio_->Value());
    if (is_valid_) {
      fit_.displacement = model_.Displacement(Elasticity().youngs_modulus);
      fit_.residual =
          observed.Restrict(fit_.displacement) - observed.Measured();
    }
  }
  if (evaluate_jacobians && is_valid_) {
    fit_.sensitivities = model_.Sensitivities(Elasticity().youngs_modulus);
    const double sign = scale_ == Scale::kLogYoungsModulus ? 1 : -1;
    jacobian_.resize(observed.Size(), 2);
    jacobian_ << sign * fit_.sensitivities.col(0),
        fit_.sensitivities.col(1) +
            SlopeAtFixedScale() * fit_.sensitivities.col(0);
  }
}

IsotropicElasticity DisplacementResidual::Elasticity() const {
  const double nu = poisson_ratio_->Value();
  if (scale_ == Scale::kLogYoungsModulus) {
    return {std::exp(scale_parameter_->Value()), nu};
  }
  return IsotropicElasticity::FromComplianceScale(
      std::exp(scale_parameter_->Value()) / Norm(model_.UnitLoadResponse()), nu,
      model_.Section());
}

double DisplacementResidual::SlopeAtFixedScale() const {
  if (scale_ == Scale::kLogYoungsModulus) {
    return 0;
  }
  const Eigen::VectorXd& w = model_.UnitLoadResponse();
  return LogYoungsModulusSlope(poisson_ratio_->Value(), model_.Section()) +
         InnerProduct(w, model_.UnitLoadResponseDerivative()) / SquaredNorm(w);
}

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

}  // namespace elastimate
