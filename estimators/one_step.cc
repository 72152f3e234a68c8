#include "elastimate/estimators/one_step.h"

#include <algorithm>
#include <cmath>
#include <sstream>

#include "elastimate/core/dense_algebra.h"
#include "elastimate/core/forward_model.h"
#include "elastimate/core/loads.h"
#include "elastimate/estimators/bounded_parameter.h"
#include "elastimate/estimators/checks.h"
#include "elastimate/estimators/displacement_fit.h"
#include "elastimate/estimators/node_losses.h"
#include "elastimate/estimators/observed_displacements.h"
#include "elastimate/estimators/profile_likelihood.h"
#include "elastimate/estimators/statistics.h"
#include "elastimate/estimators/stopwatch.h"
#include "elastimate/estimators/virtual_fields.h"

namespace elastimate {
namespace {

// Where there are no virtual fields to start from.
constexpr double kStart = 0.3;
constexpr int kMostSteps = 20;
// Of ShareOfDistanceToPole: a larger one is not that of a linear model.
constexpr double kLargestShare = 0.1;

// The fit after a step, linear in the change of the parameters.
struct Step {
  double poisson_ratio = Estimate::kUnknown;
  double compliance_scale = Estimate::kUnknown;
  /// Of nu, by the residual that is left.
  double standard_error = Estimate::kUnknown;
  Eigen::VectorXd residual;
  /// Columns w and t0 w' + v'.
  Eigen::MatrixXd responses;
};

Step TakeStep(const ObservedDisplacements& observed,
              const EstimatorOptions& options, ForwardModel& model) {
  // The derivatives are those at E = 1, where t = (1 + nu)(1 - 2 nu).
  model.Sensitivities(1);
  const Eigen::Index num_cases = model.UnitLoadResponse().cols();
  const Eigen::VectorXd w = observed.Restrict(model.UnitLoadResponse());
  const Eigen::VectorXd rest =
      observed.Measured() -
      observed.Restrict(model.SupportResponse().replicate(1, num_cases));
  const double t0 = w.dot(rest) / w.squaredNorm();
  Step step;
  step.responses.resize(w.size(), 2);
  step.responses << w,
      t0 * observed.Restrict(model.UnitLoadResponseDerivative()) +
          observed.Restrict(
              model.SupportResponseDerivative().replicate(1, num_cases));
  Eigen::Vector2d change = Eigen::Vector2d::Zero();
  if (!options.known_poisson_ratio) {
    change = SolveLeastSquares(step.responses, rest - t0 * w);
  }
  const double nu = model.PoissonRatio();
  step.poisson_ratio = nu + change(1);
  step.compliance_scale = t0 + change(0);
  if (step.poisson_ratio > -1 && step.poisson_ratio < 0.5) {
    // ||t w|| is what the data know best, and ||w|| is not linear in nu, but
    // nearly exponential at fixed E.
    const double slope =
        w.dot(observed.Restrict(model.UnitLoadResponseDerivative())) /
        w.squaredNorm();
    const double slope_at_fixed_e = slope + 1 / (1 + nu) - 2 / (1 - 2 * nu);
    step.compliance_scale =
        (t0 + change(0) + t0 * slope * change(1)) *
        std::exp(-slope_at_fixed_e * change(1)) *
        IsotropicElasticity{1, step.poisson_ratio}.ComplianceScale() /
        IsotropicElasticity{1, nu}.ComplianceScale();
  }
  step.residual = step.responses * change + t0 * w - rest;
  // The part of the derivative that w does not explain.
  const double derivative =
      (step.responses.col(1) -
       w * (w.dot(step.responses.col(1)) / w.squaredNorm()))
          .norm();
  step.standard_error = step.residual.norm() /
                        std::sqrt(static_cast<double>(w.size())) / derivative;
  return step;
}

// Du / d (ln E, nu) from the columns w and t w' + v'.
DisplacementFit DescribeStep(const ForwardModel& model, const Step& step) {
  const double nu = step.poisson_ratio;
  const double t = step.compliance_scale;
  const double dt_dnu = -(1 + 4 * nu) * t / ((1 + nu) * (1 - 2 * nu));
  DisplacementFit fit;
  fit.displacement = t * model.UnitLoadResponse();
  fit.displacement.colwise() += model.SupportResponse();
  fit.residual = step.residual;
  fit.sensitivities.resize(step.residual.size(), 2);
  fit.sensitivities << -t * step.responses.col(0),
      dt_dnu * step.responses.col(0) + step.responses.col(1);
  return fit;
}

double StartFrom(const Scene& scene, const EstimatorOptions& options,
                 Estimate& estimate) {
  if (options.known_poisson_ratio) {
    return *options.known_poisson_ratio;
  }
  const VirtualFields virtual_fields;
  if (!virtual_fields.WhyUnsupported(scene, {}).empty()) {
    return kStart;
  }
  EstimatorOptions degree;
  degree.virtual_field_degree = options.virtual_field_degree;
  const Estimate start = virtual_fields.Run(scene, degree);
  estimate.work = start.work;
  const double nu = start.elasticity.poisson_ratio;
  return nu > -1 && nu < 0.5
             ? std::clamp(nu, kSmallestPoissonRatio, kLargestPoissonRatio)
             : kStart;
}

}  // namespace

std::string_view OneStep::Name() const { return "one-step"; }

std::string_view OneStep::Description() const {
  return "one Gauss-Newton step of the displacement fit from virtual-fields; "
         "unbiased, one factorisation";
}

std::string OneStep::WhyUnsupported(const Scene& scene,
                                    const EstimatorOptions& options) const {
  if (options.poisson_ratio.AreGiven() || options.youngs_modulus.AreGiven()) {
    return "a step does not keep bounds; use reduced-fe";
  }
  if (options.loss != Loss::kNone) {
    return "one step does not minimise a loss function; use reduced-fe";
  }
  return WhyNoDisplacementFit(scene);
}

Estimate OneStep::DoRun(const Scene& scene,
                        const EstimatorOptions& options) const {
  Estimate estimate;
  Stopwatch stopwatch;
  double nu = StartFrom(scene, options, estimate);
  estimate.stages.push_back({"start", stopwatch.Lap()});
  ForwardModel model(scene.mesh, scene.supports, AssembleLoadCases(scene),
                     options.solver);
  const ObservedDisplacements observed(scene);
  estimate.stages.push_back({"assemble and analyse", stopwatch.Lap()});

  Step step;
  bool has_converged = false;
  bool is_regular = true;
  for (int i = 0; i < kMostSteps && !has_converged && is_regular; ++i) {
    if (options.on_factorization) {
      options.on_factorization(i + 1);
    }
    is_regular = model.SetPoissonRatio(nu);
    if (!is_regular) {
      break;
    }
    step = TakeStep(observed, options, model);
    const double change = std::abs(step.poisson_ratio - nu);
    const double distance = std::min(std::abs(0.5 - step.poisson_ratio),
                                     std::abs(1 + step.poisson_ratio));
    // Where nu is uncertain, the derivatives, and with them the error of E,
    // have to be those at the estimate.
    const bool is_linear =
        change <= step.standard_error ||
        step.standard_error <= kLargestLinearShare * distance;
    has_converged = change * change / distance <=
                        std::max(0.5 * step.standard_error, 1e-9) &&
                    is_linear;
    // Half of the way to a limit that the step leaves the range by.
    nu = std::clamp(step.poisson_ratio, (nu - 1) / 2, (nu + 0.5) / 2);
  }
  estimate.stages.push_back({"steps", stopwatch.Lap()});
  estimate.work = estimate.work + model.WorkDone();
  if (!is_regular) {
    estimate.message =
        "the stiffness matrix is singular to working precision; check the "
        "mesh for slivers and loose parts, and the supports";
    estimate.why_no_standard_error = "there is no estimate";
    return estimate;
  }
  estimate.elasticity = IsotropicElasticity::FromComplianceScale(
      step.compliance_scale, step.poisson_ratio);
  if (!(step.compliance_scale > 0)) {
    estimate.Fail(Status::kUnphysical, kDisplacementsOpposeLoads,
                  "the estimate is not physical");
    return estimate;
  }
  if (!estimate.elasticity.IsPhysical()) {
    estimate.Fail(Status::kUnphysical,
                  "the steps lead out of the range of Poisson's ratio; use "
                  "reduced-fe, which keeps it",
                  "the estimate is not physical");
    return estimate;
  }
  NoteSolver(model.Notice(), estimate);
  if (has_converged) {
    estimate.status = Status::kOk;
    estimate.message = "";
  } else {
    estimate.status = Status::kIterationLimit;
    estimate.message = "the steps do not settle; use reduced-fe";
  }
  DescribeDisplacementFit(scene, model.Graph(), options, observed,
                          DescribeStep(model, step), NodeLosses(),
                          ActiveBounds(), estimate);
  if (estimate.IsUsable() && !options.known_poisson_ratio &&
      ShareOfDistanceToPole(estimate) > kLargestShare) {
    std::ostringstream text;
    text << "nu = " << estimate.elasticity.poisson_ratio
         << " has a standard error of "
         << TwoDigits(*estimate.PoissonRatioStandardError())
         << ", too large for one step of a linear model; use reduced-fe";
    estimate.Fail(Status::kNotIdentifiable, text.str());
  }
  estimate.stages.push_back({"statistics", stopwatch.Lap()});
  return estimate;
}

}  // namespace elastimate
