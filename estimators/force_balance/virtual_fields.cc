#include "elastimate/estimators/force_balance/virtual_fields.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "elastimate/core/algebra/dense_algebra.h"
#include "elastimate/core/scene/loads.h"
#include "elastimate/estimators/force_balance/force_regression.h"
#include "elastimate/estimators/force_balance/force_residual.h"
#include "elastimate/estimators/force_balance/free_direction.h"
#include "elastimate/estimators/force_balance/virtual_work.h"
#include "elastimate/estimators/force_balance/virtual_work_regression.h"
#include "elastimate/estimators/force_balance/work_balance.h"
#include "elastimate/estimators/interface/judge.h"
#include "elastimate/estimators/interface/limits.h"
#include "elastimate/estimators/interface/parameter_judge.h"
#include "elastimate/estimators/interface/stopwatch.h"

namespace elastimate {
namespace {

// The sine of the angle between derivatives of the virtual work below which
// rounding, not the data, decides.
constexpr double kDependentWork = 1e-10;

// What the residual says about its causes.
struct ResidualJudgement {
  /// The variance of the weighted noise.
  double noise_variance;
  /// The square sum that may hide an error of the model of its own size.
  double model_square_sum;
};

// The covariance of the variables, by cause.
struct WorkCovariance {
  Eigen::MatrixXd noise;
  Eigen::MatrixXd model;
};

// With S = J^T J of the residual z, and N the part of S that noise of variance
// 1 makes, the bread B = S - sigma^2 N is the expectation of the derivative of
// the score, and the covariance sigma^2 B^-1 S B^-1.  In the directions where
// noise makes so much of S that chance explains all of it, nothing is known.
WorkCovariance CovarianceOf(const Eigen::MatrixXd& information,
                            const Eigen::MatrixXd& of_noise,
                            const ResidualJudgement& residual,
                            Eigen::Index num_equations) {
  // N of no signal is a sum of about as many squares.
  const double chance = 4 * std::sqrt(2 / double(num_equations));
  const double least_share = chance / (1 + chance);
  const SymmetricEigenDecomposition shares = DecomposeSymmetric(
      information - residual.noise_variance * of_noise, information);
  Eigen::VectorXd of_noise_alone(shares.values.size());
  Eigen::VectorXd of_model(shares.values.size());
  for (Eigen::Index i = 0; i < shares.values.size(); ++i) {
    const double share = shares.values(i);
    const bool is_known = share > least_share;
    of_noise_alone(i) = is_known ? residual.noise_variance / (share * share)
                                 : std::numeric_limits<double>::infinity();
    of_model(i) = is_known ? residual.model_square_sum / share : 0;
  }
  return {
      shares.vectors * of_noise_alone.asDiagonal() * shares.vectors.transpose(),
      shares.vectors * of_model.asDiagonal() * shares.vectors.transpose()};
}

FreeParameters WithoutBounds(const Scene& scene,
                             const EstimatorOptions& options) {
  Scene unbounded = scene;
  for (Material& material : unbounded.materials) {
    material.bounds.clear();
  }
  EstimatorOptions unbounded_options = options;
  unbounded_options.youngs_modulus = {};
  unbounded_options.poisson_ratio = {};
  return FreeParameters(unbounded, unbounded_options);
}

class WorkEstimate {
 public:
  WorkEstimate(const Scene& scene, const EstimatorOptions& options,
               const VirtualWork& work, const ForceResidual& forces)
      : scene_(scene),
        options_(options),
        forces_(forces),
        free_(scene, options),
        balance_(work, forces) {
    // Large rotations turn the arms of loads that are in balance.
    if (forces.Prepared().LargeForces() == nullptr) {
      evidence_.load_imbalance = work.Imbalance(AssembleLoadCases(scene));
    }
    evidence_.do_loads_work = balance_.DoLoadsWork();
    evidence_.are_forces_dependent = balance_.NumEquations() < free_.Size();
  }

  Estimate Run() {
    Stopwatch stopwatch;
    if (IsUsable() && FindMinimum() && IsUsable()) {
      Describe();
      Judge(evidence_, options_, estimate_);
      estimate_.stages.push_back({"fit", stopwatch.Lap()});
    }
    estimate_.work = forces_.WorkDone() + balance_.WorkDone();
    return estimate_;
  }

 private:
  bool IsUsable() {
    Judge(evidence_, options_, estimate_);
    return estimate_.IsUsable();
  }

  // Enters the parameters; false where there are none.
  bool FindMinimum() {
    const std::optional<BoundedMinimum> minimum =
        MinimizeWorkBalance(free_, options_.max_iterations, forces_, balance_);
    if (!minimum) {
      evidence_.do_displacements_oppose_loads = true;
      Judge(evidence_, options_, estimate_);
      return false;
    }
    minimum_ = *minimum;
    evidence_.end = minimum_.end;
    evidence_.search_message = minimum_.message;
    EnterParameters(scene_, free_, free_.ParametersAt(minimum_.variables),
                    estimate_);
    NoteVariablesOnBounds(free_, minimum_, evidence_, estimate_);
    const Eigen::VectorXd moduli = free_.ModuliAt(minimum_.variables);
    directions_ = free_.ModuliJacobian(minimum_.variables);
    if (!balance_.Evaluate(moduli, directions_, &residual_, &jacobian_)) {
      evidence_.end = End::kSearchFailed;
      return true;
    }
    NoteFreeDirection(jacobian_, kDependentWork, free_, estimate_, evidence_);
    estimate_.force_residual =
        (forces_.Columns() * moduli - forces_.Loads()).norm() /
        forces_.Loads().norm();
    return true;
  }

  // Whether something other than independent noise is in the balance of virtual
  // work: against the given noise, else against the noise that the force
  // residual shows.  Empty, with the reason, where there is nothing to learn
  // from.
  std::optional<ResidualJudgement> JudgeResidual() {
    const std::optional<double>& given = scene_.load_cases.front().noise_sd;
    const Eigen::Index redundancy = balance_.NumEquations() - free_.Size();
    if (redundancy <= 0 && !given) {
      estimate_.why_no_standard_error =
          "there are no more virtual fields than unknowns, so that the noise "
          "cannot be estimated; give its standard deviation (--noise_sd)";
      return std::nullopt;
    }
    const auto m = double(std::max<Eigen::Index>(redundancy, 1));
    const double square_sum = residual_.squaredNorm();
    const double variance = square_sum / m;
    estimate_.noise_sd = given.value_or(std::sqrt(variance));
    if (!given) {
      estimate_.noise_degrees_of_freedom = m;
    } else {
      // chi^2 has mean m and variance 2 m.
      if (redundancy <= 0 ||
          variance <= 1 + kLimits.significant_score * std::sqrt(2 / m)) {
        return ResidualJudgement{1, 0};
      }
      evidence_.above_noise = {ResidualKind::kVirtualWork, std::sqrt(variance)};
    }
    const std::optional<double> rough_variance = VarianceOfForces();
    // The stiffness colours the force residual, which takes up to three
    // quarters of its degrees of freedom.
    const double rough_m = forces_.NumEquations() / 4;
    const bool is_noise =
        !rough_variance ||
        variance <= *rough_variance * (1 + kLimits.significant_score *
                                               std::sqrt(2 / m + 2 / rough_m));
    return ResidualJudgement{variance, is_noise ? 0 : square_sum};
  }

  // The variance of the weighted noise that the force residual shows: on a
  // bound that residual is that of the bound, too.
  std::optional<double> VarianceOfForces() const {
    if (estimate_.active_bounds.empty()) {
      return NoiseVarianceAt(free_, minimum_.variables, forces_);
    }
    const FreeParameters unbounded = WithoutBounds(scene_, options_);
    const Eigen::VectorXd start =
        unbounded.VariablesOf(free_.ParametersAt(minimum_.variables));
    return FitWithoutBias(unbounded, start, forces_).noise_variance;
  }

  void Describe() {
    evidence_.correction = residual_.norm() / forces_.DisplacementNorm();
    const std::optional<ResidualJudgement> residual = JudgeResidual();
    if (!residual) {
      return;
    }
    estimate_.is_model_in_doubt = residual->model_square_sum > 0;
    const WorkCovariance covariance =
        CovarianceOf(jacobian_.transpose() * jacobian_,
                     balance_.NoiseOfInformation(directions_), *residual,
                     balance_.NumEquations());
    EnterCovariance(free_, minimum_.variables,
                    covariance.noise + covariance.model, estimate_);
    estimate_.error_budget.noise =
        ErrorsOfVariables(free_, minimum_.variables, covariance.noise);
    estimate_.error_budget.model =
        ErrorsOfVariables(free_, minimum_.variables, covariance.model);
    if (estimate_.is_model_in_doubt) {
      evidence_.virtual_work_error = LargestErrorOfStiffnesses();
    }
    MeasureBoundExcess(residual->noise_variance);
  }

  // The largest relative standard error of a stiffness.
  double LargestErrorOfStiffnesses() const {
    double largest = 0;
    for (std::size_t i = 0; i < estimate_.parameters.size(); ++i) {
      const double variance =
          estimate_.parameter_covariance(Eigen::Index(i), Eigen::Index(i));
      if (estimate_.parameters[i].IsStiffness() && variance > 0) {
        largest = std::max(
            largest, std::sqrt(variance) / estimate_.parameters[i].ErrorUnit());
      }
    }
    return largest;
  }

  // What bounds on moduli cost, where the minimum lies on some.
  void MeasureBoundExcess(double variance) {
    Eigen::Index on_bound = -1;
    for (Eigen::Index i = 0; i < free_.Size(); ++i) {
      if (minimum_.on_bound[i] != Side::kNone &&
          estimate_.parameters[free_.All().Free()[i]].is_modulus) {
        on_bound = free_.All().Free()[i];
      }
    }
    if (on_bound < 0) {
      return;
    }
    const FreeParameters free = WithoutBounds(scene_, options_);
    const std::optional<BoundedMinimum> minimum =
        MinimizeWorkBalance(free, options_.max_iterations, forces_, balance_);
    Eigen::VectorXd residual;
    if (minimum && balance_.Evaluate(free.ModuliAt(minimum->variables), {},
                                     &residual, nullptr)) {
      const ParameterEstimate& parameter = estimate_.parameters[on_bound];
      // The noise is that of the fit without the bounds.
      const double of_noise =
          residual.squaredNorm() / double(balance_.NumEquations());
      evidence_.bound_excess = {
          residual_.squaredNorm() - residual.squaredNorm(),
          std::min(variance, of_noise),
          free.ParametersAt(minimum->variables)(on_bound), parameter.value,
          parameter.Label()};
    }
  }

  const Scene& scene_;
  const EstimatorOptions& options_;
  const ForceResidual& forces_;
  FreeParameters free_;
  WorkBalance balance_;
  BoundedMinimum minimum_;
  Eigen::MatrixXd directions_;
  Eigen::VectorXd residual_;
  Eigen::MatrixXd jacobian_;
  Evidence evidence_;
  Estimate estimate_;
};

class WorkPreparation : public Preparation {
 public:
  WorkPreparation(const Scene& scene, const EstimatorOptions& options)
      : options_(options),
        work_(FieldsOfMaterials(scene, options)),
        forces_(scene) {}

  Estimate Run(const Scene& scene) override {
    return WorkEstimate(scene, options_, work_, ForceResidual(forces_, scene))
        .Run();
  }

 private:
  const EstimatorOptions& options_;
  VirtualWork work_;
  ForceScene forces_;
};

}  // namespace

std::string_view VirtualFields::Name() const { return "virtual-fields"; }

std::string_view VirtualFields::Description() const {
  return "balance of the virtual work of polynomial fields, weighted by its "
         "covariance; noise does not bias it [Avril & Pierron 2007]";
}

Capabilities VirtualFields::WhatItTakes() const {
  Capabilities capabilities;
  capabilities.needs_all_displacements = true;
  capabilities.takes_bounds = true;
  capabilities.takes_degree = true;
  capabilities.takes_materials = true;
  capabilities.takes_large_strains = true;
  capabilities.needs_linear_moduli = true;
  return capabilities;
}

Estimate VirtualFields::DoRun(const Scene& scene,
                              const EstimatorOptions& options) const {
  Stopwatch stopwatch;
  WorkPreparation preparation(scene, options);
  const double seconds = stopwatch.Lap();
  Estimate estimate = preparation.Run(scene);
  // The fields.
  ++estimate.work.element_passes;
  estimate.stages.insert(estimate.stages.begin(), {"prepare mesh", seconds});
  return estimate;
}

std::unique_ptr<Preparation> VirtualFields::DoPrepare(
    const Scene& scene, const EstimatorOptions& options) const {
  return std::make_unique<WorkPreparation>(scene, options);
}

}  // namespace elastimate
