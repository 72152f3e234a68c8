#include "elastimate/estimators/force_balance/virtual_fields.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "elastimate/core/algebra/dense_algebra.h"
#include "elastimate/core/scene/loads.h"
#include "elastimate/estimators/force_balance/force_residual.h"
#include "elastimate/estimators/force_balance/virtual_work.h"
#include "elastimate/estimators/force_balance/virtual_work_regression.h"
#include "elastimate/estimators/interface/judge.h"
#include "elastimate/estimators/interface/limits.h"
#include "elastimate/estimators/interface/stopwatch.h"
#include "elastimate/estimators/statistics/errors_on_bound.h"
#include "elastimate/estimators/statistics/profile_likelihood.h"

namespace elastimate {
namespace {

// What the residual says about its causes.
struct ResidualJudgement {
  /// Of the weighted noise.
  double noise_variance;
  /// The square sum that may hide an error of the model of its own size.
  double model_square_sum;
};

// Whether something other than independent noise is in the balance of virtual
// work: against the given noise, else against the noise that the force residual
// shows.  Empty, with the reason, where there is nothing to learn from.
std::optional<ResidualJudgement> JudgeResidual(
    const VirtualWorkFit& fit, Eigen::Index redundancy,
    const ForceResidual& force_residual,
    const std::optional<double>& given_noise_sd, Evidence& evidence,
    Estimate& estimate) {
  if (redundancy <= 0 && !given_noise_sd) {
    estimate.why_no_standard_error =
        "there are no more virtual fields than unknowns, so that the noise "
        "cannot be estimated; give its standard deviation";
    return std::nullopt;
  }
  const double m = static_cast<double>(std::max<Eigen::Index>(redundancy, 1));
  const double variance = fit.square_sum / m;
  estimate.noise_sd = given_noise_sd.value_or(std::sqrt(variance));
  if (!given_noise_sd) {
    estimate.noise_degrees_of_freedom = m;
  }
  if (given_noise_sd) {
    // chi^2 has mean m and variance 2 m.
    if (redundancy <= 0 ||
        variance <= 1 + kLimits.significant_score * std::sqrt(2 / m)) {
      return ResidualJudgement{1, 0};
    }
    evidence.above_noise = {ResidualKind::kVirtualWork, std::sqrt(variance)};
  }
  // On a bound the force residual is that of the bound, too.
  const std::optional<double> rough_variance =
      estimate.active_bounds.empty()
          ? force_residual.ResidualVariance(fit.poisson_ratio, false)
          : force_residual.ResidualVariance(
                force_residual.ErrorsInVariablesPoissonRatio(), true);
  // The stiffness colours the force residual, which takes up to three quarters
  // of its degrees of freedom.
  const double rough_m = static_cast<double>(force_residual.NumEquations()) / 4;
  const bool is_noise =
      !rough_variance ||
      variance <= *rough_variance * (1 + kLimits.significant_score *
                                             std::sqrt(2 / m + 2 / rough_m));
  return ResidualJudgement{variance, is_noise ? 0 : fit.square_sum};
}

// Information about (ln E, nu), and covariances from it.
class Information {
 public:
  Information(const VirtualWorkInformation& information,
              const IsotropicElasticity& elasticity, SectionModel model,
              const ResidualJudgement& residual)
      : residual_(residual) {
    const Eigen::Matrix2d jacobian =
        ComplianceScaleJacobian(elasticity, model) *
        Eigen::Vector2d(elasticity.youngs_modulus, 1).asDiagonal();
    score_ = jacobian.transpose() * information.score * jacobian;
    bread_ = jacobian.transpose() * information.Bread(residual.noise_variance) *
             jacobian;
  }

  // d ln E / d nu of the parameters that fit alike at a given nu.
  double YoungsModulusSlope() const { return -bread_(0, 1) / bread_(0, 0); }
  // d nu / d ln E of those that do at a given E.
  double PoissonRatioSlope() const { return -bread_(0, 1) / bread_(1, 1); }

  // Of the parameters that vary together; empty when they are not determined.
  std::optional<Eigen::MatrixXd> Covariance(
      const std::vector<Eigen::Index>& parameters) const {
    const Eigen::MatrixXd bread = bread_(parameters, parameters);
    // What is nearer to one is rounding.
    constexpr double kSingular = 1e-12;
    const double correlation =
        bread.size() == 1 ? 0
                          : bread(0, 1) / std::sqrt(bread(0, 0) * bread(1, 1));
    if (!(bread.diagonal().minCoeff() > 0 &&
          1 - correlation * correlation > kSingular)) {
      return std::nullopt;
    }
    return NoiseCovariance(parameters) + ModelCovariance(parameters);
  }

  // Its parts.  Precondition: it is not empty.
  Eigen::MatrixXd NoiseCovariance(
      const std::vector<Eigen::Index>& parameters) const {
    const Eigen::MatrixXd inverse = Inverse(bread_(parameters, parameters));
    return residual_.noise_variance * inverse * score_(parameters, parameters) *
           inverse;
  }
  Eigen::MatrixXd ModelCovariance(
      const std::vector<Eigen::Index>& parameters) const {
    return residual_.model_square_sum * Inverse(bread_(parameters, parameters));
  }

 private:
  ResidualJudgement residual_;
  Eigen::Matrix2d score_;
  Eigen::Matrix2d bread_;
};

// Fills in the covariance of a fit of which one parameter at least is free;
// false where the noise hides nu.
bool FillCovariance(const std::vector<Eigen::Index>& free,
                    const Information& information, Estimate& estimate) {
  const std::optional<Eigen::MatrixXd> covariance =
      information.Covariance(free);
  if (!covariance) {
    return false;
  }
  const Eigen::Vector2d scale(estimate.elasticity.youngs_modulus, 1);
  Eigen::Matrix2d both = Eigen::Matrix2d::Constant(Estimate::kUnknown);
  both(free, free) = information.NoiseCovariance(free);
  estimate.error_budget.noise = StandardErrors(both, {1, 0});
  both(free, free) = information.ModelCovariance(free);
  estimate.error_budget.model = StandardErrors(both, {1, 0});
  both(free, free) = *covariance;
  estimate.covariance = scale.asDiagonal() * both * scale.asDiagonal();
  return true;
}

double StandardErrorOrInfinity(const std::optional<Eigen::MatrixXd>& covariance,
                               Eigen::Index parameter) {
  return covariance ? std::sqrt((*covariance)(parameter, parameter))
                    : std::numeric_limits<double>::infinity();
}

// The nu around a fit whose S exceeds that of the fit by no more than chance:
// where the data know nothing of nu, S is sigma^2 chi^2 of k degrees of freedom
// at each nu.  Two standard deviations of the difference of two of them.
Interval IntervalByChance(const VirtualWorkBalance& balance,
                          const VirtualWorkFit& fit,
                          const ResidualJudgement& residual) {
  const double excess =
      4 * std::sqrt(static_cast<double>(balance.NumEquations()));
  const auto [lower, upper] =
      balance.ProfileEnds(fit, excess * residual.noise_variance);
  return {lower.poisson_ratio, upper.poisson_ratio};
}

// The standard errors of the sandwich, carried over to the profile of S.
void DescribeProfileOf(const VirtualWorkBalance& balance,
                       const VirtualWorkFit& fit,
                       const ResidualJudgement& residual, Evidence& evidence,
                       Estimate& estimate) {
  const VirtualWorkInformation raw = balance.InformationAt(fit);
  const std::optional<Eigen::MatrixXd> covariance =
      Information(raw, estimate.elasticity, balance.Model(), residual)
          .Covariance({0, 1});
  if (!covariance) {
    return;
  }
  // Of (nu, t), as the entry of nu is of (E, nu).
  const double variance =
      (*covariance)(1, 1) / Inverse(raw.Bread(residual.noise_variance))(0, 0);
  const auto elasticity_of = [&balance](const VirtualWorkFit& at) {
    return IsotropicElasticity::FromComplianceScale(
        at.compliance_scale, at.poisson_ratio, balance.Model());
  };
  evidence.profile_interval = DescribeProfile(
      [&](double quantile) {
        const auto [lower, upper] =
            balance.ProfileEnds(fit, quantile * variance);
        return Profile{elasticity_of(lower), elasticity_of(upper)};
      },
      estimate);
  Interval interval = *evidence.profile_interval;
  if (interval.lower == -1 || interval.upper == 0.5) {
    const Interval by_chance = IntervalByChance(balance, fit, residual);
    interval = {std::min(interval.lower, by_chance.lower),
                std::max(interval.upper, by_chance.upper)};
  }
  evidence.chance_interval = interval;
}

// What the data say of E and nu where E lies on a bound.
void MeasureYoungsModulusOnBound(
    const EstimatorOptions& options, const VirtualWorkBalance& balance,
    const VirtualWorkFit& fit, const std::optional<ResidualJudgement>& residual,
    Evidence& evidence, Estimate& estimate) {
  const bool is_known = options.known_poisson_ratio.has_value();
  const VirtualWorkFit unbounded =
      is_known
          ? balance.FitAt(fit.poisson_ratio, Bounds{})
          : balance.Minimize(EffectivePoissonRatioBounds(options), Bounds{});
  evidence.bound_excess = {
      fit.square_sum - unbounded.square_sum,
      unbounded.square_sum / static_cast<double>(balance.NumEquations()),
      IsotropicElasticity::FromComplianceScale(
          unbounded.compliance_scale, unbounded.poisson_ratio, balance.Model())
          .youngs_modulus};
  if (!residual) {
    return;
  }
  const Information information(balance.InformationAt(fit), estimate.elasticity,
                                balance.Model(), *residual);
  std::optional<Eigen::MatrixXd> covariance;
  if (is_known) {
    covariance = information.Covariance({0});
  } else {
    const Interval by_chance = IntervalByChance(balance, unbounded, *residual);
    if (by_chance.upper - by_chance.lower <=
        2 * kLimits.LargestPoissonRatioDistance()) {
      covariance = information.Covariance({0, 1});
    }
  }
  evidence.youngs_modulus_on_bound = AllowForYoungsModulusOnBound(
      options, information.PoissonRatioSlope(),
      StandardErrorOrInfinity(covariance, 0), estimate);
}

// The fit, and what it alone says.
VirtualWorkFit Fit(const EstimatorOptions& options,
                   const VirtualWorkBalance& balance, Evidence& evidence,
                   Estimate& estimate) {
  VirtualWorkFit fit =
      options.known_poisson_ratio
          ? balance.FitAt(*options.known_poisson_ratio, options.youngs_modulus)
          : balance.Minimize(EffectivePoissonRatioBounds(options),
                             options.youngs_modulus);
  evidence.do_displacements_oppose_loads = !(fit.free_compliance_scale > 0);
  estimate.elasticity = IsotropicElasticity::FromComplianceScale(
      evidence.do_displacements_oppose_loads ? fit.free_compliance_scale
                                             : fit.compliance_scale,
      fit.poisson_ratio, balance.Model());
  if (!options.known_poisson_ratio && !evidence.do_displacements_oppose_loads) {
    evidence.free_direction = balance.CollinearDirection();
  }
  if (evidence.free_direction) {
    estimate.elasticity = {Estimate::kUnknown, Estimate::kUnknown};
  }
  return fit;
}

// Fills in what the residual says of the covariance of the free parameters.
void DescribeCovariance(const EstimatorOptions& options,
                        const std::vector<Eigen::Index>& free,
                        const VirtualWorkBalance& balance,
                        const VirtualWorkFit& fit,
                        const ResidualJudgement& residual, Evidence& evidence,
                        Estimate& estimate) {
  estimate.is_model_in_doubt = residual.model_square_sum > 0;
  const Information information(balance.InformationAt(fit), estimate.elasticity,
                                balance.Model(), residual);
  evidence.is_poisson_ratio_hidden =
      !free.empty() && !FillCovariance(free, information, estimate);
  if (evidence.active.poisson_ratio != Side::kNone) {
    evidence.poisson_ratio_on_bound = AllowForPoissonRatioOnBound(
        options, evidence.active, information.YoungsModulusSlope(),
        StandardErrorOrInfinity(information.Covariance({0, 1}), 1), estimate);
  }
  if (estimate.is_model_in_doubt) {
    evidence.virtual_work_error =
        estimate.YoungsModulusStandardError().value_or(0) /
        estimate.elasticity.youngs_modulus;
  }
}

// Whether the curvature at the fit says too little of nu.
bool NeedsProfile(const EstimatorOptions& options, const ActiveBounds& active,
                  const Estimate& estimate) {
  return estimate.IsUsable() && !options.known_poisson_ratio &&
         active.youngs_modulus == Side::kNone &&
         (active.is_physical_limit ||
          (active.poisson_ratio == Side::kNone &&
           ShareOfDistanceToPole(estimate) > kLargestLinearShare));
}

// Fills in what follows from a fit of physical parameters.
void DescribeFit(const Scene& scene, const EstimatorOptions& options,
                 const VirtualWorkBalance& balance,
                 const ForceResidual& force_residual, const VirtualWorkFit& fit,
                 Evidence& evidence, Estimate& estimate) {
  const BoundedParameter poisson_ratio =
      options.known_poisson_ratio
          ? BoundedParameter::Constant(fit.poisson_ratio)
          : BoundedParameter(fit.poisson_ratio,
                             EffectivePoissonRatioBounds(options));
  evidence.active = NoteActiveBounds(options, fit.youngs_modulus_bound,
                                     poisson_ratio, estimate);
  const ActiveBounds& active = evidence.active;
  std::vector<Eigen::Index> free;
  if (active.youngs_modulus == Side::kNone) {
    free.push_back(0);
  }
  if (!options.known_poisson_ratio && active.poisson_ratio == Side::kNone) {
    free.push_back(1);
  }
  estimate.force_residual =
      force_residual.RelativeResidual(estimate.elasticity);
  const std::optional<ResidualJudgement> residual = JudgeResidual(
      fit, balance.NumEquations() - Eigen::Index(free.size()), force_residual,
      scene.load_cases.front().noise_sd, evidence, estimate);
  if (residual) {
    DescribeCovariance(options, free, balance, fit, *residual, evidence,
                       estimate);
  }
  if (active.youngs_modulus != Side::kNone) {
    MeasureYoungsModulusOnBound(options, balance, fit, residual, evidence,
                                estimate);
  }
  Judge(evidence, options, estimate);
  if (residual && NeedsProfile(options, active, estimate)) {
    DescribeProfileOf(balance, fit, *residual, evidence, estimate);
  }
  evidence.correction = std::sqrt(fit.square_sum) / balance.DisplacementNorm();
}

int DegreeOf(const EstimatorOptions& options) {
  return options.virtual_field_degree.value_or(VirtualFields::kDefaultDegree);
}

// `imbalance` is that of the loads.
Estimate BalanceWork(const VirtualWorkBalance& balance,
                     const ForceResidual& force_residual, double imbalance,
                     const Scene& scene, const EstimatorOptions& options) {
  Estimate estimate;
  Evidence evidence;
  Stopwatch stopwatch;
  estimate.work = force_residual.WorkDone();
  // The measurement, in the balance.
  ++estimate.work.element_passes;
  evidence.load_imbalance = imbalance;
  evidence.do_loads_work = balance.LoadsDoWork();
  Judge(evidence, options, estimate);
  if (!estimate.IsUsable()) {
    return estimate;
  }
  const VirtualWorkFit fit = Fit(options, balance, evidence, estimate);
  Judge(evidence, options, estimate);
  if (!estimate.IsUsable()) {
    return estimate;
  }
  DescribeFit(scene, options, balance, force_residual, fit, evidence, estimate);
  Judge(evidence, options, estimate);
  estimate.stages.push_back({"fit", stopwatch.Lap()});
  return estimate;
}

class WorkPreparation : public Preparation {
 public:
  WorkPreparation(const Scene& scene, const EstimatorOptions& options)
      : options_(options),
        work_(scene.mesh, scene.supports, DegreeOf(options)),
        forces_(scene),
        imbalance_(work_.Imbalance(AssembleLoadCases(scene))) {}

  Estimate Run(const Scene& scene) override {
    return BalanceWork(VirtualWorkBalance(work_, scene),
                       ForceResidual(forces_, scene), imbalance_, scene,
                       options_);
  }

 private:
  const EstimatorOptions& options_;
  VirtualWork work_;
  ForceScene forces_;
  double imbalance_;
};

}  // namespace

std::string_view VirtualFields::Name() const { return "virtual-fields"; }

std::string_view VirtualFields::Description() const {
  return "virtual work of polynomial fields, weighted by its own covariance; "
         "noise does not bias it [Avril & Pierron 2007]";
}

Capabilities VirtualFields::WhatItTakes() const {
  Capabilities capabilities;
  capabilities.needs_all_displacements = true;
  capabilities.takes_bounds = true;
  capabilities.takes_degree = true;
  capabilities.takes_materials = true;
  return capabilities;
}

Estimate VirtualFields::DoRun(const Scene& scene,
                              const EstimatorOptions& options) const {
  if (!IsOneIsotropicMaterial(scene.materials)) {
    return BalanceVirtualWork(scene, options);
  }
  Stopwatch stopwatch;
  const VirtualWork work(scene.mesh, scene.supports, DegreeOf(options));
  const double seconds = stopwatch.Lap();
  Estimate estimate =
      BalanceWork(VirtualWorkBalance(work, scene), ForceResidual(scene),
                  work.Imbalance(AssembleLoadCases(scene)), scene, options);
  // The fields.
  ++estimate.work.element_passes;
  estimate.stages.insert(estimate.stages.begin(), {"prepare mesh", seconds});
  return estimate;
}

std::unique_ptr<Preparation> VirtualFields::DoPrepare(
    const Scene& scene, const EstimatorOptions& options) const {
  if (!IsOneIsotropicMaterial(scene.materials)) {
    return Estimator::DoPrepare(scene, options);
  }
  return std::make_unique<WorkPreparation>(scene, options);
}

}  // namespace elastimate
