#include "elastimate/estimators/statistics/finer_specimen.h"

#include <algorithm>
#include <cmath>

namespace elastimate {
namespace {

// Of alpha of a finer specimen: more where the elements are so coarse that the
// estimate itself is far off.
constexpr double kDeviationOfShare = 0.45;
// The standard error of alpha that rounding leaves.
constexpr double kRounding = 1e-6;

}  // namespace

FinerSpecimen CompareWithFinerSpecimen(double share, double standard_error,
                                       double degrees_of_freedom, double missed,
                                       const SpecimenPrior& prior) {
  const double variance =
      std::max(standard_error * standard_error, kRounding * kRounding);
  const double variance_of_share = kDeviationOfShare * kDeviationOfShare;
  // What is missed of a usual change is in the deviation of the share.
  const double variance_if_finer =
      variance + std::max(missed * missed - variance_of_share, 0.0);
  const double n = std::max(degrees_of_freedom, 1.0);
  // Logarithms of the densities at `share`, but for a common factor.
  const auto log_density = [n](double distance, double of_variance) {
    return -0.5 * std::log(of_variance) -
           (n + 1) / 2 * std::log1p(distance * distance / of_variance / n);
  };
  const double ignorance =
      0.5 * std::log((variance_if_finer + variance_of_share) /
                     (variance + variance_of_share));
  const double log_odds =
      std::log(prior.odds) + ignorance +
      log_density(share - prior.share, variance_if_finer + variance_of_share) -
      log_density(share, variance);
  FinerSpecimen finer;
  finer.probability = 1 / (1 + std::exp(-log_odds));
  finer.share_variance = 1 / (1 / variance_if_finer + 1 / variance_of_share);
  finer.share = finer.share_variance *
                (share / variance_if_finer + prior.share / variance_of_share);
  return finer;
}

}  // namespace elastimate
