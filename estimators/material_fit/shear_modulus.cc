#include "elastimate/estimators/material_fit/shear_modulus.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include "elastimate/core/laws/elasticity.h"
#include "elastimate/core/materials/isotropic_law.h"
#include "elastimate/estimators/interface/judge.h"

namespace elastimate {
namespace {

// No nu beyond these is given: elements lock there, and mu hardly changes any
// more.
constexpr double kSmallestRatioGiven = -0.9;
constexpr double kLargestRatioGiven = 0.49;

bool IsAsked(const Scene& scene, const EstimatorOptions& options,
             const Estimate& estimate) {
  return IsOneIsotropicMaterial(scene.materials) &&
         options.kinematics != Kinematics::kLarge &&
         !options.youngs_modulus.AreGiven() &&
         !options.poisson_ratio.AreGiven() && !HasPriors(scene.materials) &&
         estimate.parameters.size() == 2 &&
         std::all_of(estimate.parameters.begin(), estimate.parameters.end(),
                     [](const ParameterEstimate& parameter) {
                       return !parameter.is_known &&
                              std::isfinite(parameter.value);
                     });
}

// Returns the ends of what the data leave open, and the middle.
std::vector<double> RatiosToGive(const ParameterEstimate& ratio) {
  double lower = kSmallestRatioGiven;
  double upper = kLargestRatioGiven;
  if (ratio.standard_error) {
    const auto within = [](double nu) {
      return std::clamp(nu, kSmallestRatioGiven, kLargestRatioGiven);
    };
    lower = within(ratio.value - *ratio.standard_error);
    upper = within(ratio.value + *ratio.standard_error);
  }
  return {lower, (lower + upper) / 2, upper};
}

double RelativeError(const Estimate& fit) {
  return std::sqrt(fit.parameter_covariance(0, 0)) / fit.parameters[0].value;
}

// Whether E is determined so well that the shear modulus, which the fits would
// cost, is not known better.
bool IsWellKnown(const ParameterEstimate& youngs_modulus) {
  constexpr double kSmallError = 0.05;
  return youngs_modulus.standard_error &&
         *youngs_modulus.standard_error < kSmallError * youngs_modulus.value;
}

IsotropicElasticity ElasticityOf(const Estimate& fit) {
  return {fit.parameters[0].value, fit.parameters[1].value};
}

// Fits E with nu given at several values.  Returns none where one of them is
// not usable or misses something smooth, so that its error may be too small,
// and where the data contradict all but one.
std::vector<Estimate> FitsWithRatio(const Scene& scene,
                                    const EstimatorOptions& options,
                                    const FitWithOptions& fit,
                                    const ParameterEstimate& ratio,
                                    Work& work) {
  std::vector<Estimate> fits;
  for (const double nu : RatiosToGive(ratio)) {
    EstimatorOptions with_ratio = options;
    with_ratio.known_poisson_ratio = nu;
    const Estimate estimate = fit(with_ratio);
    work = work + estimate.work;
    Estimate judged = estimate;
    FinishEstimate(estimate.estimator, scene, with_ratio, {}, judged);
    if (judged.Has(FindingCode::kGivenValueContradicted)) {
      continue;
    }
    if (!judged.IsUsable() || !judged.YoungsModulusStandardError() ||
        judged.Has(FindingCode::kSmoothResidual)) {
      return {};
    }
    fits.push_back(estimate);
  }
  return fits.size() < 2 ? std::vector<Estimate>() : fits;
}

const Estimate& LeastCertain(const std::vector<Estimate>& fits) {
  return *std::max_element(fits.begin(), fits.end(),
                           [](const Estimate& a, const Estimate& b) {
                             return RelativeError(a) < RelativeError(b);
                           });
}

ModulusEstimate ShearModulusOf(const std::vector<Estimate>& fits) {
  std::vector<double> logarithms;
  logarithms.reserve(fits.size());
  for (const Estimate& fit : fits) {
    logarithms.push_back(std::log(ElasticityOf(fit).ShearModulus()));
  }
  const auto [least, most] =
      std::minmax_element(logarithms.begin(), logarithms.end());
  const double value = std::exp((*least + *most) / 2);
  const Estimate& fit = LeastCertain(fits);
  const ParameterErrors& noise = fit.error_budget.noise;
  return {value, value * std::hypot((*most - *least) / 2, RelativeError(fit)),
          value * (noise.size() == 0 ? Estimate::kUnknown : noise(0))};
}

// Returns errors of E and nu that reach to the fit whose nu is furthest.
Eigen::Matrix2d CovarianceToFurthest(const std::vector<Estimate>& fits,
                                     const IsotropicElasticity& elasticity) {
  Eigen::Vector2d furthest = Eigen::Vector2d::Zero();
  for (const Estimate& fit : fits) {
    const auto [youngs_modulus, poisson_ratio] = ElasticityOf(fit);
    const Eigen::Vector2d move = {
        elasticity.youngs_modulus *
            std::log(youngs_modulus / elasticity.youngs_modulus),
        poisson_ratio - elasticity.poisson_ratio};
    if (std::abs(move(1)) > std::abs(furthest(1))) {
      furthest = move;
    }
  }
  Eigen::Matrix2d covariance = furthest * furthest.transpose();
  covariance(0, 0) += std::pow(
      RelativeError(LeastCertain(fits)) * elasticity.youngs_modulus, 2);
  return covariance;
}

// Enters errors that are not known, which are mostly those of other values that
// fit as well, beside what the fits with nu given have.
void EnterMissingErrors(const std::vector<Estimate>& fits, Estimate& estimate) {
  if (estimate.parameter_covariance.allFinite()) {
    return;
  }
  const Eigen::Matrix2d covariance =
      CovarianceToFurthest(fits, ElasticityOf(estimate));
  const Estimate& fit = LeastCertain(fits);
  estimate.parameter_covariance = covariance;
  estimate.noise_sd = fit.noise_sd;
  estimate.error_budget = fit.error_budget;
  const double of_youngs_modulus =
      std::sqrt(covariance(0, 0)) / estimate.parameters[0].value;
  estimate.error_budget.curvature = Eigen::Vector2d(
      std::sqrt(std::max(0.0, std::pow(of_youngs_modulus, 2) -
                                  std::pow(RelativeError(fit), 2))),
      std::sqrt(covariance(1, 1)));
}

}  // namespace

bool FindShearModulus(const Scene& scene, const EstimatorOptions& options,
                      const FitWithOptions& fit, Estimate& estimate) {
  if (!IsAsked(scene, options, estimate)) {
    return false;
  }
  Estimate judged = estimate;
  FinishEstimate(estimate.estimator, scene, options, {}, judged);
  const ParameterEstimate& ratio = judged.parameters[1];
  if (!judged.Has(FindingCode::kParametersUndetermined) ||
      ratio.IsDetermined() || IsWellKnown(judged.parameters[0])) {
    return false;
  }
  Work work = estimate.work;
  const std::vector<Estimate> fits =
      FitsWithRatio(scene, options, fit, ratio, work);
  estimate.work = work;
  if (fits.empty()) {
    return true;
  }
  const ModulusEstimate shear_modulus = ShearModulusOf(fits);
  if (!shear_modulus.IsDetermined() ||
      (judged.IsUsable() &&
       shear_modulus.RelativeError() > RelativeError(estimate))) {
    return true;
  }
  estimate.Accept();
  estimate.why_no_standard_error.clear();
  // The end of the range of nu says nothing of the shear modulus.
  estimate.active_bounds.clear();
  estimate.shear_modulus = shear_modulus;
  EnterMissingErrors(fits, estimate);
  return true;
}

}  // namespace elastimate
