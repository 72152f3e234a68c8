#include "elastimate/estimators/displacement_fit/material_fit.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <optional>
#include <vector>

#include "elastimate/core/algebra/dense_algebra.h"
#include "elastimate/core/equilibrium/equilibrium.h"
#include "elastimate/core/scene/observed_displacements.h"
#include "elastimate/estimators/displacement_fit/residual_statistics.h"
#include "elastimate/estimators/force_balance/virtual_fields.h"
#include "elastimate/estimators/interface/free_parameters.h"
#include "elastimate/estimators/interface/judge.h"
#include "elastimate/estimators/interface/limits.h"
#include "elastimate/estimators/interface/parameter_judge.h"
#include "elastimate/estimators/interface/stopwatch.h"
#include "elastimate/estimators/statistics/bounded_variables.h"

namespace elastimate {
namespace {

// Steps below this part of a standard error end the fit.
constexpr double kSmallestStepOfErrors = 1e-2;

// The displacements of a scene at variables x, against the measured ones.
class DisplacementMisfit {
 public:
  DisplacementMisfit(const Scene& scene, const EstimatorOptions& options)
      : free_(scene, options),
        equilibrium_(scene, options.solver),
        observed_(scene),
        on_factorization_(options.on_factorization) {}

  const FreeParameters& Free() const { return free_; }
  const ObservedDisplacements& Observed() const { return observed_; }
  Equilibrium& Model() { return equilibrium_; }

  bool Evaluate(const Eigen::VectorXd& x, Eigen::VectorXd* residual,
                Eigen::MatrixXd* jacobian) {
    if (!MoveTo(x)) {
      return false;
    }
    *residual =
        observed_.Restrict(equilibrium_.Displacement()) - observed_.Measured();
    if (jacobian != nullptr) {
      *jacobian = Sensitivities(x);
    }
    return true;
  }

 private:
  bool MoveTo(const Eigen::VectorXd& x) {
    if (x_.size() == x.size() && x_ == x) {
      return true;
    }
    x_.resize(0);
    if (on_factorization_) {
      on_factorization_(++num_factorizations_);
    }
    const Eigen::VectorXd moduli = free_.ModuliAt(x);
    if (!moduli.allFinite() || !equilibrium_.Solve(moduli) ||
        !equilibrium_.Displacement().allFinite()) {
      return false;
    }
    x_ = x;
    return true;
  }

  Eigen::MatrixXd Sensitivities(const Eigen::VectorXd& x) {
    const Eigen::Index n = free_.Size();
    const Eigen::MatrixXd of_cases =
        equilibrium_.Sensitivities(free_.ModuliJacobian(x));
    const Eigen::Index num_cases = of_cases.cols() / n;
    Eigen::MatrixXd of_all(of_cases.rows(), num_cases);
    Eigen::MatrixXd sensitivities(observed_.Size(), n);
    for (Eigen::Index i = 0; i < n; ++i) {
      for (Eigen::Index k = 0; k < num_cases; ++k) {
        of_all.col(k) = of_cases.col(n * k + i);
      }
      sensitivities.col(i) = observed_.Restrict(of_all);
    }
    return sensitivities;
  }

  FreeParameters free_;
  Equilibrium equilibrium_;
  ObservedDisplacements observed_;
  std::function<void(int)> on_factorization_;
  int num_factorizations_ = 0;
  Eigen::VectorXd x_;  ///< Where the model is; empty where it is nowhere.
};

// Typical values, their moduli scaled so that the displacements fit best; empty
// when these oppose the loads.
std::optional<Eigen::VectorXd> TypicalStart(DisplacementMisfit& misfit) {
  const FreeParameters& free = misfit.Free();
  if (const std::optional<double> known = free.All().KnownModulus()) {
    return free.VariablesOf(free.All().Typical(*known));
  }
  Equilibrium& model = misfit.Model();
  if (!model.Solve(free.All().Moduli(free.All().Typical(1)))) {
    return std::nullopt;
  }
  const ObservedDisplacements& observed = misfit.Observed();
  const Eigen::VectorXd held = observed.Restrict(
      model.SupportResponse().replicate(1, model.Displacement().cols()));
  const Eigen::VectorXd loaded = observed.Restrict(model.Displacement()) - held;
  const double compliance =
      loaded.dot(observed.Measured() - held) / loaded.squaredNorm();
  if (!(compliance > 0 && std::isfinite(compliance))) {
    return std::nullopt;
  }
  return free.VariablesOf(free.All().Typical(1 / compliance));
}

// From virtual-fields, where it has physical parameters.
std::optional<Eigen::VectorXd> VirtualFieldsStart(
    const Scene& scene, const EstimatorOptions& options,
    const FreeParameters& free, Estimate& estimate) {
  EstimatorOptions of_virtual_fields = options;
  of_virtual_fields.on_factorization = {};
  const VirtualFields virtual_fields;
  if (!virtual_fields.WhyUnsupported(scene, of_virtual_fields).empty()) {
    return std::nullopt;
  }
  const Estimate start = virtual_fields.Run(scene, of_virtual_fields);
  estimate.work = estimate.work + start.work;
  Eigen::VectorXd parameters(Eigen::Index(start.parameters.size()));
  for (Eigen::Index i = 0; i < parameters.size(); ++i) {
    parameters(i) = start.parameters[i].value;
  }
  if (parameters.size() == 0) {
    return std::nullopt;
  }
  const Eigen::VectorXd variables = free.VariablesOf(parameters);
  return variables.allFinite() ? std::optional<Eigen::VectorXd>(variables)
                               : std::nullopt;
}

BoundedMinimum Descend(const EstimatorOptions& estimator_options,
                       const Eigen::VectorXd& start,
                       DisplacementMisfit& misfit) {
  ceres::Solver::Options options;
  options.linear_solver_type = ceres::DENSE_QR;
  options.max_num_iterations = estimator_options.max_iterations;
  // Far from the minimum, Gauss-Newton steps lead weakly determined parameters
  // astray; the radius grows with each step that holds what it promised.
  options.initial_trust_region_radius = 1;
  // A step of k standard errors lowers the cost by about k^2 / n of itself.
  options.function_tolerance = kSmallestStepOfErrors * kSmallestStepOfErrors /
                               static_cast<double>(misfit.Observed().Size());
  options.gradient_tolerance = 1e-14;
  options.parameter_tolerance = 1e-11;
  options.logging_type = ceres::SILENT;
  return MinimizeOverVariables(
      [&](const Eigen::VectorXd& x, Eigen::VectorXd* residual,
          Eigen::MatrixXd* jacobian) {
        return misfit.Evaluate(x, residual, jacobian);
      },
      misfit.Observed().Size(), misfit.Free().VariableBounds(), start, options);
}

// The best minimum that the starts lead to; empty without a start.
std::optional<BoundedMinimum> BestMinimum(const Scene& scene,
                                          const EstimatorOptions& options,
                                          DisplacementMisfit& misfit,
                                          Estimate& estimate) {
  std::optional<BoundedMinimum> best;
  for (const std::optional<Eigen::VectorXd>& start :
       {TypicalStart(misfit),
        VirtualFieldsStart(scene, options, misfit.Free(), estimate)}) {
    if (start) {
      BoundedMinimum minimum = Descend(options, *start, misfit);
      if (!best || minimum.cost < best->cost) {
        best = minimum;
      }
    }
  }
  return best;
}

// The largest of moduli and of ratios.
Eigen::Vector2d LargestOf(const Eigen::VectorXd& change,
                          const Estimate& estimate,
                          const FreeParameters& free) {
  Eigen::Vector2d largest = Eigen::Vector2d::Zero();
  for (Eigen::Index i = 0; i < free.Size(); ++i) {
    const bool is_modulus =
        estimate.parameters[free.All().Free()[i]].is_modulus;
    double& value = largest(is_modulus ? 0 : 1);
    if (std::abs(change(i)) > std::abs(value)) {
      value = change(i);
    }
  }
  return largest;
}

// Enters noise, model error, outliers and covariance of a minimum.
void DescribeMinimum(const Eigen::VectorXd& variables,
                     DisplacementMisfit& misfit, Evidence& evidence,
                     Estimate& estimate) {
  const FreeParameters& free = misfit.Free();
  const ObservedDisplacements& observed = misfit.Observed();
  Eigen::VectorXd residual;
  Eigen::MatrixXd sensitivities;
  if (!misfit.Evaluate(variables, &residual, &sensitivities)) {
    evidence.end = End::kSingularStiffness;
    return;
  }
  estimate.displacement_residual = residual.norm() / observed.Measured().norm();
  if (!observed.GivenNoise() &&
      observed.Size() - free.Size() < kLimits.least_redundancy) {
    evidence.too_few_components = observed.Size();
    return;
  }
  const ResidualVariance variance = EstimateVariance(
      observed, residual.squaredNorm(), free.Size(), evidence, estimate);
  evidence.is_explained_by_given_noise = variance.is_explained_by_given_noise;
  const double smooth = variance.is_explained_by_given_noise
                            ? 0
                            : MeasureSmoothPart(misfit.Model().Graph(),
                                                observed, residual, estimate)
                                  .least;
  evidence.smooth_part = std::sqrt(smooth) / observed.Measured().norm();
  const Eigen::MatrixXd inverse =
      Inverse(sensitivities.transpose() * sensitivities);
  Eigen::MatrixXd covariance = (variance.variance + smooth) * inverse;
  estimate.error_budget.noise =
      ErrorsOfVariables(free, variance.variance * inverse);
  estimate.error_budget.model = ErrorsOfVariables(free, smooth * inverse);
  Eigen::VectorXd change = Eigen::VectorXd::Zero(free.Size());
  if (HasHeavyTails(residual)) {
    change = RobustChange(observed, residual, sensitivities);
    evidence.outlier_change = LargestOf(change, estimate, free);
  }
  covariance += change * change.transpose();
  estimate.error_budget.outliers =
      ErrorsOfVariables(free, change.cwiseAbs2().asDiagonal());
  if (smooth > 0) {
    evidence.smooth_residual_error =
        std::sqrt(covariance.diagonal().maxCoeff());
  }
  EnterCovariance(free, variables, covariance, estimate);
}

}  // namespace

Estimate FitMaterials(const Scene& scene, const EstimatorOptions& options) {
  Estimate estimate;
  Evidence evidence;
  Stopwatch stopwatch;
  DisplacementMisfit misfit(scene, options);
  estimate.stages.push_back({"assemble and analyse", stopwatch.Lap()});
  const std::optional<BoundedMinimum> minimum =
      BestMinimum(scene, options, misfit, estimate);
  estimate.stages.push_back({"fit", stopwatch.Lap()});
  if (minimum) {
    evidence.end = minimum->end;
    evidence.search_message = minimum->message;
    EnterParameters(scene, misfit.Free(), minimum->variables, estimate);
    NoteVariablesOnBounds(misfit.Free(), *minimum, estimate);
    DescribeMinimum(minimum->variables, misfit, evidence, estimate);
  } else {
    evidence.do_displacements_oppose_loads = true;
  }
  evidence.solver_notice = misfit.Model().Notice();
  Judge(evidence, options, estimate);
  estimate.stages.push_back({"statistics", stopwatch.Lap()});
  estimate.work = estimate.work + misfit.Model().WorkDone();
  return estimate;
}

}  // namespace elastimate
