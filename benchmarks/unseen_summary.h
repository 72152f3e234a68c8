#ifndef ELASTIMATE_BENCHMARKS_UNSEEN_SUMMARY_H_
#define ELASTIMATE_BENCHMARKS_UNSEEN_SUMMARY_H_

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "benchmarks/table.h"
#include "benchmarks/trial.h"

namespace elastimate {

/// Whether 95 % intervals hold the truth; empty without an interval.  A
/// millionth (of E) beyond an end counts as rounding.
struct Coverage {
  std::optional<bool> youngs_modulus;
  std::optional<bool> poisson_ratio;
};

/// Returns the interval of a parameter of one material, by its name; empty when
/// unknown.
std::optional<Interval> IntervalOf(const Estimate& estimate,
                                   const std::string& parameter);

Coverage CoverageOf(const Trial& trial);

/// Holds what an estimator made of one measurement.
struct UnseenOutcome {
  std::string world;
  std::string half;
  double deviation;
  std::string estimator;
  std::int64_t seed;  ///< One for each measurement.
  bool is_ok;
  bool is_determined;  ///< Whether it is ok and both parameters are determined.
  /// Whether it is ok, and IsWrong by its standard errors alone.
  bool is_dishonest;
  Coverage coverage;
  /// Whether the 95 % interval of the shear modulus holds it; empty unless
  /// the estimate is of the shear modulus (Estimate::shear_modulus).
  std::optional<bool> is_shear_modulus_held;
  // Errors are relative to E and absolute in nu, as in TrialCells; NaN where
  // unknown.
  double youngs_modulus_error;
  double poisson_ratio_error;
  double youngs_modulus_standard_error;
  double poisson_ratio_standard_error;
  double processor_seconds;

  /// Whether it serves the purpose: ok, and off by no more than 1 % of E and
  /// 0.01 in nu, or two of its standard errors.
  bool HasDone() const;
  /// Returns the larger of the relative error of E and the error of nu; NaN
  /// where unknown.
  double Error() const;
};

/// HasDone allows these errors.
inline constexpr double kWantedError = 0.01;  // Of relative E, and of nu.
inline constexpr double kWantedStandardErrors = 2;

/// Makes the table unseen_cells.  It has rows for each world, estimator,
/// deviation and half, and for all deviations and both halves ("all").  A row
/// gives the share of ok trials, of those that determine E and nu and of those
/// that determine the shear modulus alone; the share of intervals that hold the
/// truth, of E and nu among the ok ones (a missing interval does not), of the
/// shear modulus among those that determine it alone; the share of dishonest
/// trials among all, and medians over the ok ones.
Table UnseenCells(const std::vector<UnseenOutcome>& outcomes);

/// Makes the table unseen_regret.  It has rows for each world, deviation and
/// half, and for all of them.  A row compares `auto` with the cheapest other
/// estimator that would have done: ratios of time and of error, as medians and
/// 90 % quantiles over the measurements for which there is such an estimator.
/// An error below the wanted one counts as the wanted one.
Table UnseenRegret(const std::vector<UnseenOutcome>& outcomes);

}  // namespace elastimate

#endif  // ELASTIMATE_BENCHMARKS_UNSEEN_SUMMARY_H_
