#include "benchmarks/measurement_study.h"

#include <cmath>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "benchmarks/block_jackknife.h"
#include "benchmarks/measurement_levels.h"
#include "benchmarks/quantile.h"
#include "benchmarks/trial.h"
#include "elastimate/estimators/registry.h"

namespace elastimate {
namespace {

// The factor noise has about 3000 nodes, all other factors have 600.
constexpr int kFineCells = 54;
constexpr int kCells = 24;
constexpr int kQuickCells = 10;
constexpr int kTrials = 200;
constexpr int kJackknifeTrials = 40;
constexpr int kQuickTrials = 4;
constexpr int kQuickJackknifeTrials = 2;

// Sums the errors of one parameter over the trials of a level.  Errors of E are
// relative.
class ParameterErrorsOfLevel {
 public:
  void Add(double error, double stated, double noise, bool is_covered) {
    errors_.push_back(error);
    stated_.push_back(stated);
    square_sum_ += error * error;
    noise_square_sum_ += noise * noise;
    num_covered_ += is_covered;
  }

  std::vector<Value> Cells() const {
    const auto count = static_cast<double>(errors_.size());
    const double root_mean_square = std::sqrt(square_sum_ / count);
    return {root_mean_square, Quantile(stated_, 0.5),
            root_mean_square / std::sqrt(noise_square_sum_ / count),
            num_covered_ / count};
  }

 private:
  std::vector<double> errors_;
  std::vector<double> stated_;
  double square_sum_ = 0;
  double noise_square_sum_ = 0;
  int num_covered_ = 0;
};

// Collects the usable trials of a level, and counts the others.
class Cell {
 public:
  void Add(const Trial& trial) {
    ++num_trials_;
    const Estimate& estimate = trial.estimate;
    const std::optional<double> youngs = estimate.YoungsModulusStandardError();
    const std::optional<double> poisson = estimate.PoissonRatioStandardError();
    if (!estimate.IsUsable() || !youngs || !poisson) {
      return;
    }
    ++num_usable_;
    num_wrong_ += IsWrong(trial);
    num_warned_ += !estimate.Sentences(Severity::kWarning).empty();
    num_outliers_ += static_cast<double>(estimate.outliers.size());
    const double truth = trial.truth.youngs_modulus;
    const Interval& of_youngs = *estimate.parameters[0].interval;
    const Interval& of_poisson = *estimate.poisson_ratio_interval;
    const ParameterErrors& noise = estimate.error_budget.noise;
    youngs_modulus_.Add(trial.YoungsModulusError(), *youngs / truth, noise(0),
                        of_youngs.lower <= truth && truth <= of_youngs.upper);
    const double nu = trial.truth.poisson_ratio;
    poisson_ratio_.Add(trial.PoissonRatioError(), *poisson, noise(1),
                       of_poisson.lower <= nu && nu <= of_poisson.upper);
  }

  static Table MakeTable() {
    std::vector<std::string> columns = {
        "factor",           "level",
        "assumption",       "trials [1]",
        "usable_share [1]", "dishonest_share [1]",
        "warned_share [1]", "outliers [1]"};
    for (const std::string name : {"youngs_modulus", "poisson_ratio"}) {
      for (const std::string what :
           {"_root_mean_square_error [1]", "_standard_error [1]",
            "_error_over_noise [1]", "_coverage [1]"}) {
        columns.push_back(name + what);
      }
    }
    columns.push_back("time [s]");
    return {"measurement_cells", columns};
  }

  void AddTo(Table& table, const MeasurementLevel& level,
             double seconds) const {
    const auto trials = static_cast<double>(num_trials_);
    const auto usable = static_cast<double>(num_usable_);
    std::vector<Value> cells = {level.factor,         level.level,
                                level.assumption,     std::int64_t{num_trials_},
                                usable / trials,      num_wrong_ / trials,
                                num_warned_ / usable, num_outliers_ / usable};
    for (const ParameterErrorsOfLevel* parameter :
         {&youngs_modulus_, &poisson_ratio_}) {
      for (const Value& value : parameter->Cells()) {
        cells.push_back(value);
      }
    }
    table.AddRow(cells, {seconds});
  }

 private:
  int num_trials_ = 0;
  int num_usable_ = 0;
  int num_wrong_ = 0;
  int num_warned_ = 0;
  double num_outliers_ = 0;
  ParameterErrorsOfLevel youngs_modulus_;
  ParameterErrorsOfLevel poisson_ratio_;
};

// Compares standard errors under noise that neighbours share with those of a
// jackknife over blocks, which knows nothing of the correlation.
Table CompareWithJackknife(const std::vector<MeasurementLevel>& levels,
                           const Estimator& estimator, int num_trials,
                           Progress& progress) {
  constexpr int kBlocksAlongASide = 5;
  Table table(
      "measurement_jackknife",
      {"level", "trials [1]", "youngs_modulus_root_mean_square_error [1]",
       "youngs_modulus_standard_error [1]", "youngs_modulus_noise_error [1]",
       "youngs_modulus_jackknife_error [1]",
       "poisson_ratio_root_mean_square_error [1]",
       "poisson_ratio_standard_error [1]", "poisson_ratio_noise_error [1]",
       "poisson_ratio_jackknife_error [1]"});
  for (const MeasurementLevel& level : levels) {
    if (level.factor != kCorrelationFactor) {
      continue;
    }
    progress.Show("measurement: jackknife, " + level.factor + ", " +
                  level.level);
    // The columns sum the squares of errors, of standard errors, of the part of
    // these that independent noise makes, and of errors by the jackknife.
    Eigen::Matrix<double, 2, 4> square_sums =
        Eigen::Matrix<double, 2, 4>::Zero();
    int num_compared = 0;
    for (int seed = 1; seed <= num_trials; ++seed) {
      const Scene scene = level.measure(seed);
      const Estimate estimate = estimator.Run(scene, {});
      const std::optional<Eigen::Vector2d> jackknife =
          BlockJackknife(estimator, scene, kBlocksAlongASide);
      if (!estimate.IsUsable() || !jackknife) {
        continue;
      }
      ++num_compared;
      Eigen::Matrix<double, 2, 4> errors;
      errors << std::log(estimate.elasticity.youngs_modulus /
                         kMeasuredSteel.youngs_modulus),
          *estimate.YoungsModulusStandardError() /
              estimate.elasticity.youngs_modulus,
          estimate.error_budget.noise(0), (*jackknife)(0),
          estimate.elasticity.poisson_ratio - kMeasuredSteel.poisson_ratio,
          *estimate.PoissonRatioStandardError(), estimate.error_budget.noise(1),
          (*jackknife)(1);
      square_sums += errors.cwiseAbs2();
    }
    const Eigen::Matrix<double, 2, 4> roots =
        (square_sums / num_compared).cwiseSqrt();
    std::vector<Value> cells = {level.level, std::int64_t{num_compared}};
    for (int parameter = 0; parameter < 2; ++parameter) {
      for (const double root : roots.row(parameter)) {
        cells.emplace_back(root);
      }
    }
    table.AddRow(cells);
  }
  return table;
}

}  // namespace

StudyResult RunMeasurementStudy(bool is_quick, Progress& progress) {
  const int num_trials = is_quick ? kQuickTrials : kTrials;
  std::vector<MeasurementLevel> levels =
      NoiseLevels(is_quick ? kQuickCells : kFineCells);
  for (const MeasurementLevel& level :
       MeasurementLevels(is_quick ? kQuickCells : kCells)) {
    levels.push_back(level);
  }
  const auto estimator = MakeEstimator("iterative-fe");
  Table table = Cell::MakeTable();
  for (const MeasurementLevel& level : levels) {
    progress.Show("measurement: " + level.factor + ", " + level.level + ", " +
                  level.assumption);
    Cell cell;
    std::vector<double> seconds;
    for (int seed = 1; seed <= num_trials; ++seed) {
      Trial trial;
      trial.seed = seed;
      trial.truth = kMeasuredSteel;
      trial.estimate = estimator->Run(level.measure(seed), {});
      seconds.push_back(trial.estimate.seconds);
      cell.Add(trial);
    }
    cell.AddTo(table, level, Quantile(seconds, 0.5));
  }
  const Table jackknife = CompareWithJackknife(
      levels, *estimator, is_quick ? kQuickJackknifeTrials : kJackknifeTrials,
      progress);
  return {{table, jackknife},
          {{"specimen",
            "a quarter of a plate of 10 x 10 x 1 mm with a hole of radius 2.5 "
            "mm, quadrilaterals, E = 210 000 N/mm^2, nu = 0.3, pulled by 1500 "
            "N or a rigid grip"},
           {"unless_said_otherwise",
            "Gaussian noise of 1 um at all nodes, ends that were measured, and "
            "a load cell of 0.5 %"},
           {"cells", is_quick ? kQuickCells : kCells},
           {"cells_of_noise", is_quick ? kQuickCells : kFineCells},
           {"noise_seeds", "1 to the number of trials"},
           {"dishonest_standard_errors", kWrongStandardErrors},
           {"dishonest_youngs_modulus_error", kWrongYoungsModulus},
           {"dishonest_poisson_ratio_error", kWrongPoissonRatio}}};
}

}  // namespace elastimate
