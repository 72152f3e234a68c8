#include "elastimate/estimators/force_balance/bounded.h"

#include <ceres/autodiff_cost_function.h>
#include <ceres/solver.h>

#include <algorithm>
#include <cmath>

#include "elastimate/estimators/force_balance/force_regression.h"
#include "elastimate/estimators/force_balance/force_residual.h"
#include "elastimate/estimators/force_balance/virtual_work_check.h"
#include "elastimate/estimators/interface/judge.h"
#include "elastimate/estimators/statistics/bounded_parameter.h"

namespace elastimate {
namespace {

// R (-t, nu, 1)^T, relative to the norm of the load term at the start.
struct CompressedForceResidual {
  Eigen::Matrix3d triangle;
  double reference_youngs_modulus;
  SectionModel model;

  template <typename T>
  bool operator()(const T* log_youngs_modulus, const T* poisson_ratio,
                  T* residual) const {
    const T nu = *poisson_ratio;
    const T t = ComplianceFactor(nu, model) /
                (reference_youngs_modulus * exp(*log_youngs_modulus));
    for (int row = 0; row < 3; ++row) {
      residual[row] =
          -triangle(row, 0) * t + triangle(row, 1) * nu + triangle(row, 2);
    }
    return true;
  }
};

// A point within the bounds where E > 0: the unbounded minimiser moved into
// the bounds if it will do, else the end where E is positive, if there is one.
std::optional<IsotropicElasticity> Start(const ForceResidual& residual,
                                         const EstimatorOptions& options) {
  std::vector<double> candidates;
  if (options.known_poisson_ratio) {
    candidates = {*options.known_poisson_ratio};
  } else {
    const Bounds bounds = EffectivePoissonRatioBounds(options);
    const double nu =
        residual.PoissonRatio().value_or((*bounds.lower + *bounds.upper) / 2);
    candidates = {std::clamp(nu, *bounds.lower, *bounds.upper), *bounds.lower,
                  *bounds.upper};
  }
  for (const double nu : candidates) {
    const IsotropicElasticity elasticity = residual.At(nu);
    if (elasticity.IsPhysical() && std::isfinite(elasticity.youngs_modulus)) {
      return elasticity;
    }
  }
  return std::nullopt;
}

// The range of ln(E / E0) where no bound is given: what leaves it runs to zero
// or infinity.
constexpr double kLargestLogarithm = 50;

// ln(E / E0) and nu.
struct Parameters {
  BoundedParameter log_youngs_modulus;
  BoundedParameter poisson_ratio;
};

Parameters MakeParameters(const EstimatorOptions& options,
                          const IsotropicElasticity& start) {
  Bounds log_bounds = {-kLargestLogarithm, kLargestLogarithm};
  if (options.youngs_modulus.lower) {
    log_bounds.lower =
        std::log(*options.youngs_modulus.lower / start.youngs_modulus);
  }
  if (options.youngs_modulus.upper) {
    log_bounds.upper =
        std::log(*options.youngs_modulus.upper / start.youngs_modulus);
  }
  return {BoundedParameter(0, log_bounds),
          options.known_poisson_ratio
              ? BoundedParameter::Constant(*options.known_poisson_ratio)
              : BoundedParameter(start.poisson_ratio,
                                 EffectivePoissonRatioBounds(options))};
}

ceres::Solver::Summary Minimize(const ForceResidual& residual,
                                const IsotropicElasticity& start,
                                Parameters& parameters) {
  const Eigen::Matrix3d& triangle = residual.Triangle();
  const double scale =
      std::abs(start.ComplianceScale(residual.Model()) * triangle(0, 0));
  ceres::Problem problem;
  problem.AddResidualBlock(
      new ceres::AutoDiffCostFunction<CompressedForceResidual, 3, 1, 1>(
          new CompressedForceResidual{triangle / scale, start.youngs_modulus,
                                      residual.Model()}),
      nullptr, parameters.log_youngs_modulus.Block(),
      parameters.poisson_ratio.Block());

  // Three residuals cost nothing: iterate to rounding.
  ceres::Solver::Options options;
  options.linear_solver_type = ceres::DENSE_QR;
  options.max_num_iterations = 500;
  options.function_tolerance = 0;
  options.gradient_tolerance = 1e-16;
  options.parameter_tolerance = 1e-15;
  options.logging_type = ceres::SILENT;
  return MinimizeWithinBounds(
      options, {&parameters.log_youngs_modulus, &parameters.poisson_ratio},
      problem);
}

// Which of the parameters that were sought lie on no bound.
struct ParametersOffBounds {
  bool youngs_modulus;
  bool poisson_ratio;
};

// What there is to judge of the minimum.  The bias of an E on a bound is that
// of what virtual work has left of it, and follows.
void Describe(const ForceResidual& residual, const EstimatorOptions& options,
              const ParametersOffBounds& free, Evidence& evidence,
              Estimate& estimate) {
  residual.Describe(free.youngs_modulus, free.poisson_ratio, evidence,
                    estimate);
  if (evidence.active.is_physical_limit) {
    // E runs to zero or infinity with 1 - 2 nu: its value says nothing.
    estimate.elasticity.youngs_modulus = Estimate::kUnknown;
  } else if (!free.youngs_modulus) {
    evidence.youngs_modulus_on_bound =
        residual.AllowForYoungsModulusOnBound(options, estimate);
  } else if (options.known_poisson_ratio) {
    evidence.unbiased = MeasureUnbiasedPoissonRatio(residual, estimate);
  } else {
    evidence.noise_bias = MeasureNoiseBias(
        residual, EffectivePoissonRatioBounds(options), estimate);
  }
}

Estimate RunBounded(const ForceResidual& residual, const Scene& scene,
                    const EstimatorOptions& options) {
  Estimate estimate;
  Evidence evidence;
  evidence.is_biased_by_noise = true;
  estimate.work = residual.WorkDone();
  const std::optional<IsotropicElasticity> start = Start(residual, options);
  if (!start) {
    evidence.do_displacements_oppose_loads = true;
    Judge(evidence, options, estimate);
    return estimate;
  }
  Parameters parameters = MakeParameters(options, *start);
  const ceres::Solver::Summary summary = Minimize(residual, *start, parameters);
  evidence.does_youngs_modulus_diverge =
      summary.IsSolutionUsable() &&
      std::abs(parameters.log_youngs_modulus.Value()) == kLargestLogarithm;
  if (!summary.IsSolutionUsable()) {
    evidence.end = End::kSearchFailed;
    evidence.search_message = summary.message;
  }
  if (!summary.IsSolutionUsable() || evidence.does_youngs_modulus_diverge) {
    Judge(evidence, options, estimate);
    return estimate;
  }
  estimate.elasticity = {
      start->youngs_modulus * std::exp(parameters.log_youngs_modulus.Value()),
      parameters.poisson_ratio.Value()};
  evidence.active =
      NoteActiveBounds(options, parameters.log_youngs_modulus.OnBound(),
                       parameters.poisson_ratio, estimate);
  const ParametersOffBounds free = {
      evidence.active.youngs_modulus == Side::kNone,
      !options.known_poisson_ratio &&
          evidence.active.poisson_ratio == Side::kNone};
  if (!options.known_poisson_ratio && free.youngs_modulus &&
      !residual.PoissonRatio()) {
    estimate.elasticity = {Estimate::kUnknown, Estimate::kUnknown};
    evidence.free_direction = residual.CollinearDirection();
    Judge(evidence, options, estimate);
    return estimate;
  }
  Describe(residual, options, free, evidence, estimate);
  Judge(evidence, options, estimate);
  evidence.work_check = CheckByVirtualWork(scene, options, estimate);
  if (estimate.IsUsable() && !free.youngs_modulus &&
      !options.known_poisson_ratio) {
    evidence.noise_bias = MeasureNoiseBias(
        residual, EffectivePoissonRatioBounds(options), estimate);
  }
  Judge(evidence, options, estimate);
  return estimate;
}

}  // namespace

std::string_view Bounded::Name() const { return "bounded"; }

std::string_view Bounded::Description() const {
  return "closed-form with bounds on nu and E, by Ceres [Becker & Teschner "
         "2007, eq. 24]";
}

Capabilities Bounded::WhatItTakes() const {
  Capabilities capabilities;
  capabilities.needs_all_displacements = true;
  capabilities.takes_bounds = true;
  capabilities.takes_materials = true;
  return capabilities;
}

Estimate Bounded::DoRun(const Scene& scene,
                        const EstimatorOptions& options) const {
  return IsOneIsotropicMaterial(scene.materials)
             ? RunBounded(ForceResidual(scene), scene, options)
             : RegressForces(scene, options, true);
}

std::unique_ptr<Preparation> Bounded::DoPrepare(
    const Scene& scene, const EstimatorOptions& options) const {
  if (!IsOneIsotropicMaterial(scene.materials)) {
    return Estimator::DoPrepare(scene, options);
  }
  return PrepareForceResidual(scene, options, RunBounded);
}

}  // namespace elastimate
