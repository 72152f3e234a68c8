#include "elastimate/estimators/material_fit/material_fit.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <vector>

#include "elastimate/core/algebra/dense_algebra.h"
#include "elastimate/core/scene/observed_displacements.h"
#include "elastimate/estimators/statistics/residual_statistics.h"
#include "elastimate/estimators/force_balance/virtual_fields.h"
#include "elastimate/estimators/interface/free_parameters.h"
#include "elastimate/estimators/interface/judge.h"
#include "elastimate/estimators/interface/limits.h"
#include "elastimate/estimators/interface/parameter_judge.h"
#include "elastimate/estimators/interface/stopwatch.h"
#include "elastimate/estimators/material_fit/displacement_misfit.h"
#include "elastimate/estimators/statistics/bounded_variables.h"

namespace elastimate {
namespace {

// Steps below this part of a standard error end the fit.
constexpr double kSmallestStepOfErrors = 1e-2;
// Of a row of displacements without noise, the norm of all of which is 1.
constexpr double kLeastNoise = 1e-12;

// Typical values, their moduli scaled so that the displacements fit best; empty
// when these oppose the loads.
std::optional<Eigen::VectorXd> TypicalStart(DisplacementMisfit& misfit) {
  const FreeParameters& free = misfit.Free();
  if (const std::optional<double> known = free.All().KnownModulus()) {
    return free.VariablesOf(free.All().Typical(*known));
  }
  const std::optional<double> compliance =
      misfit.Compliance(free.All().Moduli(free.All().Typical(1)));
  return compliance ? std::optional<Eigen::VectorXd>(free.VariablesOf(
                          free.All().Typical(1 / *compliance)))
                    : std::nullopt;
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
                               static_cast<double>(misfit.NumRows());
  options.gradient_tolerance = 1e-14;
  options.parameter_tolerance = 1e-11;
  options.logging_type = ceres::SILENT;
  return MinimizeOverVariables(
      [&](const Eigen::VectorXd& x, Eigen::VectorXd* residual,
          Eigen::MatrixXd* jacobian) {
        return misfit.Evaluate(x, residual, jacobian);
      },
      misfit.NumRows(), misfit.Free().VariableBounds(), start, options);
}

// The standard deviation of a displacement row at x, as given or from what is
// left there; zero where there is none.
double NoiseAt(const Eigen::VectorXd& x, DisplacementMisfit& misfit) {
  const ObservedDisplacements& observed = misfit.Observed();
  if (observed.GivenNoise()) {
    return 1 / observed.Norm();
  }
  Eigen::VectorXd residual;
  if (!misfit.Evaluate(x, &residual, nullptr)) {
    return 0;
  }
  const Eigen::Index redundancy =
      observed.Size() - misfit.NumAmounts() - misfit.Free().Size();
  return residual.head(observed.Size()).norm() /
         std::sqrt(static_cast<double>(std::max<Eigen::Index>(redundancy, 1)));
}

// From the start on, with resultants that weigh as much as their errors say
// beside those of the displacements, which the fit shows.
BoundedMinimum DescendWithResultants(const EstimatorOptions& options,
                                     const Eigen::VectorXd& start,
                                     DisplacementMisfit& misfit) {
  constexpr int kWeightings = 5;
  constexpr double kSettled = 0.05;
  double noise = std::max(NoiseAt(start, misfit), kLeastNoise);
  misfit.SetNoise(noise);
  BoundedMinimum minimum = Descend(options, start, misfit);
  for (int i = 0; i < kWeightings && misfit.NumResultants() > 0; ++i) {
    const double last = noise;
    noise = std::max(NoiseAt(minimum.variables, misfit), kLeastNoise);
    if (std::abs(noise - last) < kSettled * last) {
      break;
    }
    misfit.SetNoise(noise);
    minimum = Descend(options, minimum.variables, misfit);
  }
  return minimum;
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
      BoundedMinimum minimum =
          misfit.NumResultants() > 0
              ? DescendWithResultants(options, *start, misfit)
              : Descend(options, *start, misfit);
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
  Eigen::VectorXd rows;
  Eigen::MatrixXd sensitivities;
  if (!misfit.Evaluate(variables, &rows, &sensitivities)) {
    evidence.end = End::kSingularStiffness;
    return;
  }
  const Eigen::VectorXd residual = rows.head(observed.Size());
  estimate.displacement_residual = residual.norm() / observed.Measured().norm();
  const Eigen::Index num_fitted =
      free.Size() + misfit.NumAmounts() - misfit.NumResultants();
  if (!observed.GivenNoise() &&
      observed.Size() - num_fitted < kLimits.least_redundancy) {
    evidence.too_few_components = observed.Size();
    return;
  }
  const ResidualVariance variance = EstimateVariance(
      observed, rows.squaredNorm(), num_fitted, evidence, estimate);
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
    change = RobustChange(observed, residual,
                          sensitivities.topRows(observed.Size()));
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

// Where Poisson's ratio of one isotropic material is known, that material.
std::vector<Material> WithKnownPoissonRatio(const EstimatorOptions& options) {
  Material material;
  material.known.push_back({"poisson_ratio", *options.known_poisson_ratio});
  return {material};
}

// E and nu of one isotropic material, and their covariance.
void EnterElasticity(Estimate& estimate) {
  if (!estimate.parameters.empty()) {
    estimate.elasticity = {estimate.parameters[0].value,
                           estimate.parameters[1].value};
  }
  if (estimate.parameter_covariance.size() != 0) {
    estimate.covariance = estimate.parameter_covariance;
  }
}

}  // namespace

Estimate FitMaterials(const Scene& scene, const EstimatorOptions& options) {
  if (IsOneIsotropicMaterial(scene.materials) && options.known_poisson_ratio) {
    Scene known = scene;
    known.materials = WithKnownPoissonRatio(options);
    EstimatorOptions other_options = options;
    other_options.known_poisson_ratio.reset();
    Estimate estimate = FitMaterials(known, other_options);
    EnterElasticity(estimate);
    return estimate;
  }
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
  if (IsOneIsotropicMaterial(scene.materials)) {
    EnterElasticity(estimate);
  }
  evidence.solver_notice = misfit.Model().Notice();
  Judge(evidence, options, estimate);
  estimate.stages.push_back({"statistics", stopwatch.Lap()});
  estimate.work = estimate.work + misfit.Model().WorkDone();
  return estimate;
}

}  // namespace elastimate
