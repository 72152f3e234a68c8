#include "benchmarks/unseen_summary.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <iterator>
#include <limits>
#include <map>
#include <tuple>

#include "benchmarks/quantile.h"

namespace elastimate {
namespace {

using Outcomes = std::vector<const UnseenOutcome*>;

constexpr double kRounding = 1e-6;
constexpr const char* kAll = "all";
// Stands for all deviations in a key, and sorts behind each of them.
constexpr double kAllDeviations = std::numeric_limits<double>::infinity();

Value DeviationCell(double deviation) {
  return deviation == kAllDeviations ? Value(kAll) : Value(deviation);
}

std::optional<bool> Holds(const std::optional<Interval>& interval, double truth,
                          double rounding) {
  if (!interval) {
    return std::nullopt;
  }
  return interval->lower - rounding <= truth &&
         truth <= interval->upper + rounding;
}

bool IsWithin(double error, double standard_error) {
  const double tolerance =
      std::isnan(standard_error)
          ? kWantedError
          : std::max(kWantedError, kWantedStandardErrors * standard_error);
  return std::abs(error) <= tolerance;
}

double Share(const Outcomes& outcomes,
             const std::function<bool(const UnseenOutcome&)>& condition) {
  if (outcomes.empty()) {
    return Estimate::kUnknown;
  }
  const auto count = std::count_if(
      outcomes.begin(), outcomes.end(),
      [&](const UnseenOutcome* outcome) { return condition(*outcome); });
  return static_cast<double>(count) / static_cast<double>(outcomes.size());
}

double Median(const Outcomes& outcomes, double UnseenOutcome::*number) {
  std::vector<double> values;
  for (const UnseenOutcome* outcome : outcomes) {
    values.push_back(outcome->*number);
  }
  return MedianMagnitude(values);
}

// Returns the outcomes by key.  A key has a deviation and a half; further keys
// collect all deviations and both halves.
template <typename Key, typename MakeKey>
std::map<Key, Outcomes> Grouped(const std::vector<UnseenOutcome>& outcomes,
                                const MakeKey& make_key) {
  std::map<Key, Outcomes> groups;
  for (const UnseenOutcome& outcome : outcomes) {
    for (const double deviation : {outcome.deviation, kAllDeviations}) {
      for (const std::string& half : {outcome.half, std::string(kAll)}) {
        groups[make_key(outcome, deviation, half)].push_back(&outcome);
      }
    }
  }
  return groups;
}

// Compares `auto` with the cheapest other estimator that would have done.
struct Regret {
  int num_measurements = 0;
  int num_done = 0;
  int num_done_by_auto = 0;
  std::vector<double> time;
  std::vector<double> error;

  // Adds the outcomes of one measurement.  Does nothing where `auto` was not
  // run.
  void Add(const Outcomes& outcomes) {
    const UnseenOutcome* of_auto = nullptr;
    const UnseenOutcome* cheapest = nullptr;
    for (const UnseenOutcome* outcome : outcomes) {
      if (outcome->estimator == "auto") {
        of_auto = outcome;
      } else if (outcome->HasDone() &&
                 (cheapest == nullptr ||
                  outcome->processor_seconds < cheapest->processor_seconds)) {
        cheapest = outcome;
      }
    }
    if (of_auto == nullptr) {
      return;
    }
    ++num_measurements;
    num_done_by_auto += of_auto->HasDone();
    if (cheapest != nullptr) {
      ++num_done;
      time.push_back(of_auto->processor_seconds / cheapest->processor_seconds);
      // std::max keeps an error that is NaN, since it is the first argument.
      error.push_back(std::max(of_auto->Error(), kWantedError) /
                      std::max(cheapest->Error(), kWantedError));
    }
  }
};

bool DeterminesShearModulus(const UnseenOutcome& outcome) {
  return outcome.is_shear_modulus_held.has_value();
}

}  // namespace

std::optional<Interval> IntervalOf(const Estimate& estimate,
                                   const std::string& parameter) {
  for (const ParameterEstimate& own : estimate.parameters) {
    if (own.name == parameter) {
      return own.interval;
    }
  }
  return std::nullopt;
}

Coverage CoverageOf(const Trial& trial) {
  const double youngs_modulus = trial.truth.youngs_modulus;
  return {Holds(IntervalOf(trial.estimate, "youngs_modulus"), youngs_modulus,
                kRounding * youngs_modulus),
          Holds(IntervalOf(trial.estimate, "poisson_ratio"),
                trial.truth.poisson_ratio, kRounding)};
}

bool UnseenOutcome::HasDone() const {
  return is_ok &&
         IsWithin(youngs_modulus_error, youngs_modulus_standard_error) &&
         IsWithin(poisson_ratio_error, poisson_ratio_standard_error);
}

double UnseenOutcome::Error() const {
  return std::isnan(youngs_modulus_error)
             ? youngs_modulus_error
             : std::max(std::abs(youngs_modulus_error),
                        std::abs(poisson_ratio_error));
}

Table UnseenCells(const std::vector<UnseenOutcome>& outcomes) {
  Table table(
      "unseen_cells",
      {"world", "estimator", "displacement_deviation [1]", "half", "trials [1]",
       "ok_share [1]", "determined_share [1]", "shear_modulus_share [1]",
       "youngs_modulus_coverage [1]", "poisson_ratio_coverage [1]",
       "shear_modulus_coverage [1]", "dishonest_share [1]",
       "median_youngs_modulus_error [1]", "median_poisson_ratio_error [1]",
       "median_youngs_modulus_standard_error [1]",
       "median_poisson_ratio_standard_error [1]"});
  using Key = std::tuple<std::string, std::string, double, std::string>;
  const auto make_key = [](const UnseenOutcome& outcome, double deviation,
                           const std::string& half) {
    return Key{outcome.world, outcome.estimator, deviation, half};
  };
  for (const auto& [key, own] : Grouped<Key>(outcomes, make_key)) {
    const auto& [world, estimator, deviation, half] = key;
    Outcomes ok;
    std::copy_if(own.begin(), own.end(), std::back_inserter(ok),
                 [](const UnseenOutcome* outcome) { return outcome->is_ok; });
    Outcomes of_shear_modulus;
    std::copy_if(own.begin(), own.end(), std::back_inserter(of_shear_modulus),
                 [](const UnseenOutcome* outcome) {
                   return DeterminesShearModulus(*outcome);
                 });
    table.AddRow(
        {world, estimator, DeviationCell(deviation), half,
         std::int64_t(own.size()),
         Share(own, [](const UnseenOutcome& o) { return o.is_ok; }),
         Share(own, [](const UnseenOutcome& o) { return o.is_determined; }),
         Share(own, DeterminesShearModulus),
         Share(ok,
               [](const UnseenOutcome& o) {
                 return o.coverage.youngs_modulus.value_or(false);
               }),
         Share(ok,
               [](const UnseenOutcome& o) {
                 return o.coverage.poisson_ratio.value_or(false);
               }),
         Share(of_shear_modulus,
               [](const UnseenOutcome& o) { return *o.is_shear_modulus_held; }),
         Share(own, [](const UnseenOutcome& o) { return o.is_dishonest; }),
         Median(ok, &UnseenOutcome::youngs_modulus_error),
         Median(ok, &UnseenOutcome::poisson_ratio_error),
         Median(ok, &UnseenOutcome::youngs_modulus_standard_error),
         Median(ok, &UnseenOutcome::poisson_ratio_standard_error)});
  }
  return table;
}

Table UnseenRegret(const std::vector<UnseenOutcome>& outcomes) {
  Table table("unseen_regret",
              {"world", "displacement_deviation [1]", "half",
               "measurements [1]", "done_share [1]", "done_by_auto_share [1]",
               "median_time_ratio [1]", "90_percent_time_ratio [1]",
               "median_error_ratio [1]", "90_percent_error_ratio [1]"});
  using Key = std::tuple<std::string, double, std::string>;
  const auto make_key = [](const UnseenOutcome& outcome, double deviation,
                           const std::string& half) {
    return Key{outcome.world, deviation, half};
  };
  for (const auto& [key, own] : Grouped<Key>(outcomes, make_key)) {
    const auto& [world, deviation, half] = key;
    std::map<std::int64_t, Outcomes> measurements;
    for (const UnseenOutcome* outcome : own) {
      measurements[outcome->seed].push_back(outcome);
    }
    Regret regret;
    for (const auto& [seed, of_measurement] : measurements) {
      regret.Add(of_measurement);
    }
    const auto share = [&](int count) {
      return count / static_cast<double>(regret.num_measurements);
    };
    table.AddRow({world, DeviationCell(deviation), half,
                  std::int64_t{regret.num_measurements}, share(regret.num_done),
                  share(regret.num_done_by_auto), Quantile(regret.time, 0.5),
                  Quantile(regret.time, 0.9), Quantile(regret.error, 0.5),
                  Quantile(regret.error, 0.9)});
  }
  return table;
}

}  // namespace elastimate
