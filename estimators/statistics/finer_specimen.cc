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
  // Logarithms of the densities at `share` over their largest.
  const auto log_decay = [n](double distance, double of_variance) {
    return -(n + 1) / 2 * std::log1p(distance * distance / of_variance / n);
  };
  // The largest are as if nothing were missed.
  const double log_odds =
      std::log(prior.odds) +
      0.5 * std::log(variance / (variance + variance_of_share)) +
      log_decay(share - prior.share, variance_if_finer + variance_of_share) -
      log_decay(share, variance);
  FinerSpecimen finer;
  finer.probability = 1 / (1 + std::exp(-log_odds));
  finer.share_variance = 1 / (1 / variance_if_finer + 1 / variance_of_share);
  finer.share = finer.share_variance *
                (share / variance_if_finer + prior.share / variance_of_share);
  return finer;
}

}  // namespace elastimate
