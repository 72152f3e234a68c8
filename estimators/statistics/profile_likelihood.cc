#include "elastimate/estimators/statistics/profile_likelihood.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <string>

#include "elastimate/estimators/interface/estimator.h"
#include "elastimate/estimators/interface/limits.h"
#include "elastimate/estimators/statistics/error_propagation.h"

namespace elastimate {
namespace {

// The standard errors to another minimum.
constexpr double kFar = 4;

// Widens the standard errors to a profile likelihood with a 95 % interval of
// nu, each end with the E that fits best there.  An end at the limit of the
// range is left out.  One at another minimum is as likely as the estimate,
// however near the other end is.
void WidenToProfile(const Profile& profile, Estimate& estimate) {
  const double poisson_ratio_error =
      estimate.PoissonRatioStandardError().value_or(INFINITY);
  Eigen::Vector2d square_sum = Eigen::Vector2d::Zero();
  Eigen::Vector2d of_other_minimum = Eigen::Vector2d::Zero();
  int num_ends = 0;
  for (const IsotropicElasticity& end : {profile.lower, profile.upper}) {
    if (end.poisson_ratio > kSmallestPoissonRatio &&
        end.poisson_ratio < kLargestPoissonRatio) {
      const Eigen::Vector2d square =
          Eigen::Vector2d(
              end.youngs_modulus - estimate.elasticity.youngs_modulus,
              end.poisson_ratio - estimate.elasticity.poisson_ratio)
              .cwiseAbs2();
      square_sum += square;
      ++num_ends;
      if (square(1) > std::pow(kFar * poisson_ratio_error, 2)) {
        of_other_minimum = of_other_minimum.cwiseMax(square);
      }
    }
  }
  if (num_ends == 0) {
    return;
  }
  const Eigen::Vector2d error =
      (square_sum / num_ends).cwiseMax(of_other_minimum).cwiseSqrt() /
      kTwoSidedErrors;
  // Of a parameter that varies; NaN compares false.
  const auto factor = [&](int i) {
    const double ratio = error(i) / std::sqrt(estimate.covariance(i, i));
    return ratio > 1 ? ratio : 1;
  };
  // Whatever its cause is, an error is as much larger as the model is curved.
  PropagateErrors(
      Eigen::Vector2d(factor(0), factor(1)).asDiagonal().toDenseMatrix(),
      estimate);
}

}  // namespace

double ShareOfDistanceToPole(const Estimate& estimate) {
  const double nu = estimate.elasticity.poisson_ratio;
  return estimate.PoissonRatioStandardError().value_or(0) /
         std::min(0.5 - nu, 1 + nu);
}

Profile Hull(const Profile& one, const Profile& other) {
  const auto is_less = [](const IsotropicElasticity& a,
                          const IsotropicElasticity& b) {
    return a.poisson_ratio < b.poisson_ratio;
  };
  return {std::min(one.lower, other.lower, is_less),
          std::max(one.upper, other.upper, is_less)};
}

bool HasRivalMinimum(const std::function<Profile(double quantile)>& profile_of,
                     const Estimate& estimate) {
  const Profile profile = profile_of(kTwoSidedQuantile);
  const double nu = estimate.elasticity.poisson_ratio;
  const std::optional<double> error = estimate.PoissonRatioStandardError();
  return error && (profile.upper.poisson_ratio - nu > kFar * *error ||
                   nu - profile.lower.poisson_ratio > kFar * *error);
}

Interval DescribeProfile(
    const std::function<Profile(double quantile)>& profile_of,
    Estimate& estimate) {
  Profile profile = profile_of(kTwoSidedQuantile);
  WidenToProfile(profile, estimate);
  const bool reaches_upper =
      profile.upper.poisson_ratio >= kLargestPoissonRatio;
  const bool reaches_lower =
      profile.lower.poisson_ratio <= kSmallestPoissonRatio;
  if (reaches_upper != reaches_lower) {
    profile = profile_of(kOneSidedQuantile);
  }
  estimate.poisson_ratio_interval = {
      reaches_lower ? -1 : profile.lower.poisson_ratio,
      reaches_upper ? 0.5 : profile.upper.poisson_ratio};
  return *estimate.poisson_ratio_interval;
}

}  // namespace elastimate
