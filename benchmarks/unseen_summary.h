#ifndef ELASTIMATE_BENCHMARKS_UNSEEN_SUMMARY_H_
#define ELASTIMATE_BENCHMARKS_UNSEEN_SUMMARY_H_

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "benchmarks/table.h"
#include "benchmarks/trial.h"

namespace elastimate {

/// Whether a 95 % interval holds the truth, up to a millionth (of E), which is
/// rounding; empty without an interval.
struct Coverage {
  std::optional<bool> youngs_modulus;
  std::optional<bool> poisson_ratio;
};

/// The interval of a parameter of one material, by its name; empty when
/// unknown.
std::optional<Interval> IntervalOf(const Estimate& estimate,
                                   const std::string& parameter);

Coverage CoverageOf(const Trial& trial);

/// What an estimator made of one measurement.
struct UnseenOutcome {
  std::string world;
  std::string half;
  double deviation;
  std::string estimator;
  std::int64_t seed;  ///< One for each measurement.
  bool is_ok;
  /// Ok, and IsWrong by its standard errors alone.
  bool is_dishonest;
  Coverage coverage;
  // These are as in TrialCells; NaN where unknown.
  double youngs_modulus_error;
  double poisson_ratio_error;
  double youngs_modulus_standard_error;
  double poisson_ratio_standard_error;
  double processor_seconds;

  /// Whether it serves the purpose: ok, and off by no more than 1 % of E and
  /// 0.01 in nu, or two of its standard errors.
  bool HasDone() const;
  /// The larger error of relative E and of nu; NaN where unknown.
  double Error() const;
};

/// What counts as done.
inline constexpr double kWantedError = 0.01;  // Of relative E, and of nu.
inline constexpr double kWantedStandardErrors = 2;

/// Table unseen_cells: for each world, estimator, deviation and half, and for
/// all deviations and both halves ("all"), the share of ok among the trials,
/// what the intervals of those cover (a missing one covers nothing), the share
/// of dishonest ones among all trials, and medians over the ok ones.
Table UnseenCells(const std::vector<UnseenOutcome>& outcomes);

/// Table unseen_regret: for each world, deviation and half, and for all of
/// them, what `auto` took and missed by, over that of the cheapest other
/// estimator that would have done; medians and 90 % quantiles over the
/// measurements for which there is one.  An error below the wanted one counts
/// as that.
Table UnseenRegret(const std::vector<UnseenOutcome>& outcomes);

}  // namespace elastimate

#endif  // ELASTIMATE_BENCHMARKS_UNSEEN_SUMMARY_H_
