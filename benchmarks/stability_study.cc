#include "benchmarks/stability_study.h"

#include <algorithm>
#include <cmath>
#include <memory>
#include <optional>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include "benchmarks/quantile.h"
#include "benchmarks/stability_factors.h"
#include "benchmarks/trial.h"
#include "elastimate/estimators/plan/expected_information.h"
#include "elastimate/estimators/registry.h"

namespace elastimate {
namespace {

constexpr int kFullTrials = 30;
constexpr int kQuickTrials = 2;

// A method is an estimator with its options, and a row of the charts.
struct Method {
  std::string name;
  std::shared_ptr<const Estimator> estimator;
  EstimatorOptions options;
};

std::vector<Method> Methods() {
  std::vector<Method> methods;
  for (const std::string_view name : EstimatorNames()) {
    methods.push_back({std::string(name), MakeEstimator(name), {}});
    // The worlds are of linear elasticity, however large displacements are.
    methods.back().options.kinematics = Kinematics::kSmall;
  }
  for (const char* name : {"reduced-fe", "iterative-fe"}) {
    methods.push_back({name + std::string(" huber"), MakeEstimator(name), {}});
    methods.back().options.loss = Loss::kHuber;
  }
  return methods;
}

enum class Outcome {
  kHonest,
  kDishonest,
  kNotKnowable,  // Wrong, in a way that the data cannot show.
  kNotUsable,
  kUnsupported,
};

std::string OutcomeName(Outcome outcome) {
  switch (outcome) {
    case Outcome::kHonest:
      return "honest";
    case Outcome::kDishonest:
      return "dishonest";
    case Outcome::kNotKnowable:
      return "not_knowable";
    case Outcome::kNotUsable:
      return "not_usable";
    case Outcome::kUnsupported:
      break;
  }
  return "unsupported";
}

struct Judged {
  Trial trial;
  Outcome outcome;
};

// Returns NaN where the bound is not defined: without noise, or where the model
// is not held or singular.
Eigen::Matrix2d BoundOrNothing(const Scene& scene,
                               const StabilityLevel& level) {
  if (!(level.noise_sd > 0)) {
    return Eigen::Matrix2d::Constant(Estimate::kUnknown);
  }
  try {
    return CramerRaoBound(scene, level.truth.Parameters(),
                          Eigen::VectorXd::Constant(1, level.noise_sd));
  } catch (const std::exception&) {
    return Eigen::Matrix2d::Constant(Estimate::kUnknown);
  }
}

Judged Judge(const Method& method, const Scene& scene,
             const StabilityLevel& level, Trial trial) {
  if (method.estimator->WhyUnsupported(scene, method.options).empty()) {
    trial.estimate = method.estimator->Run(scene, method.options);
    trial.estimate.estimator = method.name;
    if (!trial.estimate.IsUsable()) {
      return {trial, Outcome::kNotUsable};
    }
    if (!IsWrong(trial)) {
      return {trial, Outcome::kHonest};
    }
    // All measurements come from linear elements.  An estimate by quadratic
    // elements is made where these explain the data as well, so the data cannot
    // show that it is wrong.
    const bool is_knowable =
        level.is_knowable && trial.estimate.element_order == 1;
    return {trial, is_knowable ? Outcome::kDishonest : Outcome::kNotKnowable};
  }
  trial.estimate.estimator = method.name;
  return {trial, Outcome::kUnsupported};
}

Table TrialTable() {
  std::vector<std::string> columns = {"factor",
                                      "level",
                                      "outcome",
                                      "poisson_ratio_lower [1]",
                                      "poisson_ratio_upper [1]",
                                      "warnings [1]",
                                      "element_order [1]"};
  const std::vector<std::string> trial_columns = TrialColumns();
  columns.insert(columns.end(), trial_columns.begin(), trial_columns.end());
  return {"stability", columns};
}

void AddTrial(const StabilityLevel& level, const Judged& judged, Table& table) {
  const Estimate& estimate = judged.trial.estimate;
  const Interval interval = estimate.poisson_ratio_interval.value_or(
      Interval{Estimate::kUnknown, Estimate::kUnknown});
  std::vector<Value> cells = TrialCells(judged.trial);
  if (judged.outcome == Outcome::kUnsupported) {
    const std::vector<std::string> columns = TrialColumns();
    cells[std::find(columns.begin(), columns.end(), "status") -
          columns.begin()] = OutcomeName(judged.outcome);
  }
  table.AddRow({level.factor, level.level, OutcomeName(judged.outcome),
                interval.lower, interval.upper,
                std::int64_t(estimate.Sentences(Severity::kWarning).size()),
                std::int64_t{estimate.element_order}},
               cells);
}

// Collects the trials of one method at one level.
class Cell {
 public:
  void Add(const Judged& judged) {
    const Estimate& estimate = judged.trial.estimate;
    youngs_modulus_errors_.push_back(judged.trial.YoungsModulusError());
    poisson_ratio_errors_.push_back(judged.trial.PoissonRatioError());
    num_unsupported_ += judged.outcome == Outcome::kUnsupported;
    num_not_usable_ += judged.outcome == Outcome::kNotUsable;
    num_not_knowable_ += judged.outcome == Outcome::kNotKnowable;
    if (judged.outcome == Outcome::kDishonest) {
      ++num_dishonest_;
      num_silent_ += estimate.Sentences(Severity::kWarning).empty();
      first_dishonest_seed_ = first_dishonest_seed_.value_or(judged.trial.seed);
    }
  }

  static Table MakeTable() {
    return {
        "stability_cells",
        {"factor", "level", "estimator", "trials [1]",
         "median_youngs_modulus_error [1]", "median_poisson_ratio_error [1]",
         "unsupported_share [1]", "failure_rate [1]", "not_knowable_share [1]",
         "dishonest_share [1]", "dishonest_share_without_warning [1]",
         "first_dishonest_seed [1]"}};
  }

  void AddTo(Table& table, const StabilityLevel& level,
             const std::string& method) const {
    const auto count = std::int64_t(youngs_modulus_errors_.size());
    const auto share = [&](int number) {
      return number / static_cast<double>(count);
    };
    table.AddRow(
        {level.factor, level.level, method, count,
         MedianMagnitude(youngs_modulus_errors_),
         MedianMagnitude(poisson_ratio_errors_), share(num_unsupported_),
         share(num_unsupported_ + num_not_usable_), share(num_not_knowable_),
         share(num_dishonest_), share(num_silent_),
         first_dishonest_seed_ ? Value(*first_dishonest_seed_)
                               : Value(Estimate::kUnknown)});
  }

 private:
  std::vector<double> youngs_modulus_errors_;
  std::vector<double> poisson_ratio_errors_;
  int num_unsupported_ = 0;
  int num_not_usable_ = 0;
  int num_not_knowable_ = 0;
  int num_dishonest_ = 0;
  int num_silent_ = 0;
  std::optional<std::int64_t> first_dishonest_seed_;
};

}  // namespace

StudyResult RunStabilityStudy(bool is_quick, Progress& progress) {
  const int num_trials = is_quick ? kQuickTrials : kFullTrials;
  const std::vector<Method> methods = Methods();
  Table trials = TrialTable();
  Table cells = Cell::MakeTable();
  for (const StabilityLevel& level : StabilityLevels()) {
    progress.Show("stability: " + level.factor + ", " + level.level);
    std::vector<Cell> of_methods(methods.size());
    for (int seed = 1; seed <= num_trials; ++seed) {
      const Scene scene = level.measure(seed);
      const Trial trial = {seed, level.truth, BoundOrNothing(scene, level), {}};
      for (std::size_t i = 0; i < methods.size(); ++i) {
        if (methods[i].options.loss == Loss::kNone || level.is_with_huber) {
          const Judged judged = Judge(methods[i], scene, level, trial);
          AddTrial(level, judged, trials);
          of_methods[i].Add(judged);
        }
      }
    }
    for (std::size_t i = 0; i < methods.size(); ++i) {
      if (methods[i].options.loss == Loss::kNone || level.is_with_huber) {
        of_methods[i].AddTo(cells, level, methods[i].name);
      }
    }
  }
  return {{trials, cells},
          {{"base",
            "0.5 x 0.4 x 0.4 m, 400 tetrahedra, held at x = 0, traction (200, "
            "0, -100) Pa at the other end, E = 10 kPa, nu = 0.3, deviation of "
            "the displacement 1 %"},
           {"noise_law", "uniform"},
           {"noise_seeds", "1 to the number of trials; column seed"},
           {"seeds_of_chosen_nodes", "1000000 + column seed"},
           {"dishonest_standard_errors", kWrongStandardErrors},
           {"dishonest_youngs_modulus_error", kWrongYoungsModulus},
           {"dishonest_poisson_ratio_error", kWrongPoissonRatio}}};
}

}  // namespace elastimate
