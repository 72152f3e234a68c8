#include "elastimate/estimators/material_fit/shear_modulus.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include "elastimate/core/laws/elasticity.h"
#include "elastimate/core/materials/isotropic_law.h"
#include "elastimate/estimators/interface/judge.h"
#include "elastimate/estimators/interface/limits.h"

namespace elastimate {
namespace {

// Nearer to the ends of the range elements lock, and mu hardly changes any
// more.
constexpr double kSmallest = -0.9;
constexpr double kLargest = 0.49;

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
std::vector<double> RatiosToLookAt(const ParameterEstimate& ratio) {
  double lower = kSmallest;
  double upper = kLargest;
  if (ratio.standard_error) {
    lower =
        std::clamp(ratio.value - *ratio.standard_error, kSmallest, kLargest);
    upper =
        std::clamp(ratio.value + *ratio.standard_error, kSmallest, kLargest);
  }
  return {lower, (lower + upper) / 2, upper};
}

// What the fits with nu given leave open of mu, and of E and nu.
struct Profile {
  std::vector<Estimate> fits;
  ModulusEstimate shear_modulus = {0, 0};
  double largest_error = 0;  ///< Of E of a fit, relative.
};

// Returns the fits that are usable, and none where too few are.
Profile ProfileOf(const Scene& scene, const EstimatorOptions& options,
                  const FitWithOptions& fit, const ParameterEstimate& ratio) {
  Profile profile;
  double smallest = std::numeric_limits<double>::infinity();
  double largest = 0;
  for (const double nu : RatiosToLookAt(ratio)) {
    EstimatorOptions with_ratio = options;
    with_ratio.known_poisson_ratio = nu;
    Estimate estimate = fit(with_ratio);
    FinishEstimate(estimate.estimator, scene, with_ratio, {}, estimate);
    if (estimate.Has(FindingCode::kGivenValueContradicted)) {
      continue;
    }
    const std::optional<double> error = estimate.YoungsModulusStandardError();
    if (!estimate.IsUsable() || !error) {
      return {};
    }
    const double modulus = estimate.elasticity.ShearModulus();
    smallest = std::min(smallest, modulus);
    largest = std::max(largest, modulus);
    profile.largest_error = std::max(
        profile.largest_error, *error / estimate.elasticity.youngs_modulus);
    profile.fits.push_back(estimate);
  }
  if (profile.fits.size() < 2) {
    return {};
  }
  const double value = std::sqrt(smallest * largest);
  profile.shear_modulus = {value,
                           value * std::hypot(std::log(largest / smallest) / 2,
                                              profile.largest_error)};
  return profile;
}

// Enters errors of E and nu that are not known: the distance to the furthest
// fit of the profile.
void EnterMissingErrors(const Profile& profile, Estimate& estimate) {
  Eigen::MatrixXd& covariance = estimate.parameter_covariance;
  if (covariance.array().isFinite().all()) {
    return;
  }
  const double youngs_modulus = estimate.parameters[0].value;
  Eigen::Vector2d furthest = Eigen::Vector2d::Zero();
  for (const Estimate& fit : profile.fits) {
    const Eigen::Vector2d move = {
        youngs_modulus *
            std::log(fit.elasticity.youngs_modulus / youngs_modulus),
        fit.elasticity.poisson_ratio - estimate.parameters[1].value};
    if (std::abs(move(1)) > std::abs(furthest(1))) {
      furthest = move;
    }
  }
  covariance = furthest * furthest.transpose();
  covariance(0, 0) += std::pow(profile.largest_error * youngs_modulus, 2);
  const Estimate& middle = profile.fits[profile.fits.size() / 2];
  estimate.noise_sd = middle.noise_sd;
  estimate.error_budget = middle.error_budget;
  estimate.error_budget.curvature =
      covariance.diagonal().cwiseSqrt().cwiseQuotient(
          Eigen::Vector2d(youngs_modulus, 1));
}

}  // namespace

void FindShearModulus(const Scene& scene, const EstimatorOptions& options,
                      const FitWithOptions& fit, Estimate& estimate) {
  if (!IsAsked(scene, options, estimate)) {
    return;
  }
  Estimate judged = estimate;
  FinishEstimate(estimate.estimator, scene, options, {}, judged);
  const ParameterEstimate& ratio = judged.parameters[1];
  // Data that determine a nu next to -1 are not those of a material.
  if (!judged.IsRefusedFor(FindingCode::kParametersUndetermined) ||
      (ratio.value < kSmallest && ratio.IsDetermined())) {
    return;
  }
  const Profile profile = ProfileOf(scene, options, fit, ratio);
  for (const Estimate& of_ratio : profile.fits) {
    estimate.work = estimate.work + of_ratio.work;
  }
  if (profile.fits.empty() || !profile.shear_modulus.IsDetermined()) {
    return;
  }
  estimate.Accept();
  estimate.why_no_standard_error.clear();
  estimate.shear_modulus = profile.shear_modulus;
  EnterMissingErrors(profile, estimate);
}

}  // namespace elastimate
