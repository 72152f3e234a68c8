// Runs the quick study of error bars on unseen shapes, and checks its trials
// against theory.

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <functional>
#include <iterator>
#include <limits>
#include <map>
#include <set>
#include <string>
#include <vector>

#include "tests/benchmarks/tables.h"
#include "tests/program.h"

namespace elastimate {
namespace {

using testing::kPoissonRatioError;
using testing::kYoungsModulusError;
using testing::ReadTable;
using testing::TableRow;

using Rows = std::vector<TableRow>;
using Condition = std::function<bool(const TableRow&)>;

// The numbers have seven digits, and 1 was subtracted from some of them.
constexpr double kSevenDigits = 1e-6;
constexpr const char* kNoise = "displacement_deviation [1]";

Rows Where(const Rows& rows, const Condition& condition) {
  Rows some;
  std::copy_if(rows.begin(), rows.end(), std::back_inserter(some), condition);
  return some;
}

Rows Of(const Rows& rows, const std::string& world,
        const std::string& estimator, const std::string& deviation) {
  return Where(rows, [&](const TableRow& row) {
    return row.Text("world") == world && row.Text("estimator") == estimator &&
           row.Text(kNoise) == deviation;
  });
}

int Count(const Rows& rows, const Condition& condition) {
  return static_cast<int>(Where(rows, condition).size());
}

bool IsOk(const TableRow& row) { return row.Text("status") == "ok"; }

// Without noise, the elements that made the data fit them, and find the truth.
void ExpectTheTruthWithoutNoise(const Rows& rows) {
  for (const char* estimator : {"reduced-fe", "iterative-fe"}) {
    const Rows exact = Of(rows, "same mesh", estimator, "0");
    EXPECT_FALSE(exact.empty());
    for (const TableRow& row : exact) {
      SCOPED_TRACE(row.Text("shape") + ", " + row.Text("load") + ", " +
                   estimator);
      EXPECT_TRUE(IsOk(row));
      EXPECT_LT(std::abs(row.Number(kYoungsModulusError)), kSevenDigits);
      EXPECT_LT(std::abs(row.Number(kPoissonRatioError)), kSevenDigits);
    }
  }
}

// The data have no noise, so the residual is the error of the elements.
void ExpectTheFinerWorldToBeMissed(const Rows& rows) {
  for (const char* world : {"finer world", "hexahedra"}) {
    const Rows exact = Of(rows, world, "reduced-fe", "0");
    EXPECT_FALSE(exact.empty());
    for (const TableRow& row : exact) {
      EXPECT_GT(row.Number("displacement_residual [1]"), 1e-4)
          << row.Text("shape") << ", " << row.Text("load") << ", " << world;
    }
  }
}

// Returns the probability of at most `count` successes in `trials`, each of
// which has this probability.
double BinomialProbability(int count, int trials, double probability) {
  double sum = 0;
  for (int k = 0; k <= count; ++k) {
    sum += std::exp(std::lgamma(trials + 1) - std::lgamma(k + 1) -
                    std::lgamma(trials - k + 1) + k * std::log(probability) +
                    (trials - k) * std::log1p(-probability));
  }
  return sum;
}

// On the same mesh, 95 % intervals hold the truth as often as they say.  The
// test fails on a count so small that fewer than one in 1000 studies would have
// it.
void ExpectCoverageOnTheSameMesh(const Rows& rows) {
  for (const char* estimator : {"reduced-fe", "iterative-fe"}) {
    const Rows ok = Where(Of(rows, "same mesh", estimator, "0.01"), IsOk);
    for (const char* column :
         {"youngs_modulus_is_covered [1]", "poisson_ratio_is_covered [1]"}) {
      const int covered = Count(
          ok, [&](const TableRow& row) { return row.Number(column) == 1; });
      EXPECT_GT(BinomialProbability(covered, static_cast<int>(ok.size()), 0.95),
                0.001)
          << estimator << ", " << column << ": " << covered << " of "
          << ok.size();
    }
  }
}

// This is the definition in the README, computed from columns of the table.
bool IsDishonestByStandardErrors(const TableRow& row) {
  // A missing standard error counts as zero, a missing interval as empty.
  const auto is_off = [&](const char* error, const char* standard_error,
                          double least) {
    const double size = std::abs(row.Number(error));
    return size > least && !(size <= 3 * row.Number(standard_error));
  };
  const double nu = row.Number("true_poisson_ratio [1]");
  return IsOk(row) && (is_off(kYoungsModulusError,
                              "youngs_modulus_standard_error [1]", 0.1) ||
                       (is_off(kPoissonRatioError,
                               "poisson_ratio_standard_error [1]", 0.03) &&
                        !(row.Number("poisson_ratio_lower [1]") <= nu &&
                          nu <= row.Number("poisson_ratio_upper [1]"))));
}

// In a finer world at least nine of ten intervals hold the truth, and at most
// one trial of 200 is dishonest.  The test fails on counts that fewer than one
// in 1000 studies would have.
void ExpectHonesty(const Rows& rows, const std::string& world,
                   const std::vector<std::string>& estimators) {
  for (const std::string& estimator : estimators) {
    const Rows all = Where(rows, [&](const TableRow& row) {
      return row.Text("world") == world && row.Text("estimator") == estimator;
    });
    const int num_honest = Count(all, [](const TableRow& row) {
      return !IsDishonestByStandardErrors(row);
    });
    EXPECT_GT(BinomialProbability(num_honest, int(all.size()), 0.995), 0.001)
        << estimator << ": " << num_honest << " of " << all.size();
    const Rows ok = Where(all, IsOk);
    EXPECT_FALSE(ok.empty()) << estimator;
    for (const char* column :
         {"youngs_modulus_is_covered [1]", "poisson_ratio_is_covered [1]"}) {
      const int covered = Count(
          ok, [&](const TableRow& row) { return row.Number(column) == 1; });
      EXPECT_GT(BinomialProbability(covered, int(ok.size()), 0.9), 0.001)
          << estimator << ", " << column << ": " << covered << " of "
          << ok.size();
    }
  }
}

void ExpectIntervalsAndWhatTheyCover(const Rows& rows) {
  for (const TableRow& row : rows) {
    const double nu = row.Number("true_poisson_ratio [1]");
    const auto expect_covered = [&](const std::string& parameter,
                                    double truth) {
      const double lower = row.Number(parameter + "_lower [1]");
      const double upper = row.Number(parameter + "_upper [1]");
      const double covered = row.Number(parameter + "_is_covered [1]");
      EXPECT_EQ(std::isnan(lower), std::isnan(covered));
      if (!std::isnan(lower)) {
        EXPECT_LE(lower, upper);
        // At an end of the interval, the rounding of the table may decide.
        EXPECT_LE(covered, lower - 2 * kSevenDigits <= truth &&
                               truth <= upper + 2 * kSevenDigits);
        EXPECT_GE(covered, lower <= truth && truth <= upper);
      }
    };
    expect_covered("youngs_modulus", 1);
    expect_covered("poisson_ratio", nu);
  }
}

// Each measurement has one seed, and all estimators see that measurement.
void ExpectOneSeedForEachMeasurement(const Rows& rows) {
  std::map<std::string, std::set<std::string>> settings_of_seeds;
  std::map<std::string, std::set<std::string>> estimators_of_seeds;
  for (const TableRow& row : rows) {
    const std::string& seed = row.Text("seed");
    settings_of_seeds[seed].insert(
        row.Text("shape") + "/" + row.Text("load") + "/" + row.Text("world") +
        "/" + row.Text(kNoise) + "/" + row.Text("true_poisson_ratio [1]"));
    EXPECT_TRUE(estimators_of_seeds[seed].insert(row.Text("estimator")).second);
  }
  for (const auto& [seed, settings] : settings_of_seeds) {
    EXPECT_EQ(settings.size(), 1) << seed;
  }
}

void ExpectCellsAddUpMeasurements(const Rows& rows, const Rows& cells) {
  for (const TableRow& cell : cells) {
    const Rows own = Where(rows, [&](const TableRow& row) {
      return row.Text("world") == cell.Text("world") &&
             row.Text("estimator") == cell.Text("estimator") &&
             (cell.Text(kNoise) == "all" ||
              row.Text(kNoise) == cell.Text(kNoise)) &&
             (cell.Text("half") == "all" ||
              row.Text("half") == cell.Text("half"));
    });
    const Rows ok = Where(own, IsOk);
    const auto size = static_cast<double>(own.size());
    EXPECT_EQ(cell.Number("trials [1]"), size);
    EXPECT_NEAR(cell.Number("ok_share [1]") * size,
                static_cast<double>(ok.size()), kSevenDigits * size);
    EXPECT_NEAR(cell.Number("determined_share [1]") * size,
                Count(ok,
                      [](const TableRow& row) {
                        return row.Number("youngs_modulus_standard_error [1]") <
                                   (1 + row.Number(kYoungsModulusError)) / 3 &&
                               row.Number("poisson_ratio_standard_error [1]") <
                                   0.15;
                      }),
                kSevenDigits * size);
    for (const std::string parameter : {"youngs_modulus", "poisson_ratio"}) {
      if (!ok.empty()) {
        EXPECT_NEAR(cell.Number(parameter + "_coverage [1]") *
                        static_cast<double>(ok.size()),
                    Count(ok,
                          [&](const TableRow& row) {
                            return row.Number(parameter + "_is_covered [1]") ==
                                   1;
                          }),
                    kSevenDigits * size);
      }
    }
    EXPECT_NEAR(cell.Number("dishonest_share [1]") * size,
                Count(own, IsDishonestByStandardErrors), kSevenDigits * size);
  }
}

// This is the definition in the README, computed from columns of the table.
bool HasDone(const TableRow& row) {
  const auto is_within = [&](const char* error, const char* standard_error) {
    const double two_errors = 2 * row.Number(standard_error);
    return std::abs(row.Number(error)) <=
           (two_errors > 0.01 ? two_errors : 0.01);
  };
  return IsOk(row) &&
         is_within(kYoungsModulusError, "youngs_modulus_standard_error [1]") &&
         is_within(kPoissonRatioError, "poisson_ratio_standard_error [1]");
}

void ExpectRegretOfTheTrials(const Rows& rows, const Rows& regrets) {
  int count = 0;
  for (const TableRow& regret : regrets) {
    if (regret.Text(kNoise) != "all" || regret.Text("half") != "all") {
      continue;
    }
    std::map<std::string, Rows> measurements;
    for (const TableRow& row : rows) {
      if (row.Text("world") == regret.Text("world")) {
        measurements[row.Text("seed")].push_back(row);
      }
    }
    std::vector<double> ratios;
    for (const auto& [seed, own] : measurements) {
      double auto_time = 0;
      double least = std::numeric_limits<double>::infinity();
      for (const TableRow& row : own) {
        const double time = row.Number("processor_time [s]");
        if (row.Text("estimator") == "auto") {
          auto_time = time;
        } else if (HasDone(row)) {
          least = std::min(least, time);
        }
      }
      if (auto_time > 0 && std::isfinite(least)) {
        ratios.push_back(auto_time / least);
      }
    }
    EXPECT_NEAR(
        regret.Number("done_share [1]") * regret.Number("measurements [1]"),
        static_cast<double>(ratios.size()), 0.01);
    if (ratios.empty()) {
      continue;
    }
    ++count;
    std::sort(ratios.begin(), ratios.end());
    const double median = regret.Number("median_time_ratio [1]");
    EXPECT_GE(median, ratios[(ratios.size() - 1) / 2] * (1 - kSevenDigits));
    EXPECT_LE(median, ratios[ratios.size() / 2] * (1 + kSevenDigits));
  }
  EXPECT_GT(count, 0);
}

class UnseenStudyRemade : public testing::ProgramTest {};

TEST_F(UnseenStudyRemade, FindsWhatTheoryPredicts) {
  Succeed("study --name=unseen --out=. --quick");
  const Rows rows = ReadTable(folder_ / "unseen.csv");
  ExpectTheTruthWithoutNoise(rows);
  ExpectTheFinerWorldToBeMissed(rows);
  ExpectCoverageOnTheSameMesh(rows);
  ExpectHonesty(rows, "finer world", {"reduced-fe", "auto"});
  ExpectHonesty(rows, "same mesh with outliers",
                {"reduced-fe huber", "auto huber"});
  ExpectHonesty(rows, "finer world with outliers", {"auto"});
  ExpectIntervalsAndWhatTheyCover(rows);
  ExpectOneSeedForEachMeasurement(rows);
  ExpectCellsAddUpMeasurements(rows, ReadTable(folder_ / "unseen_cells.csv"));
  ExpectRegretOfTheTrials(rows, ReadTable(folder_ / "unseen_regret.csv"));

  const std::string plot =
      std::string(ELASTIMATE_PLOT) + " '" + folder_.string() + "'";
  ASSERT_EQ(std::system(plot.c_str()), 0);
  for (const char* chart : {"unseen_cells.svg", "unseen_cells.png",
                            "unseen_regret.svg", "unseen_regret.png"}) {
    EXPECT_TRUE(std::filesystem::exists(folder_ / chart)) << chart;
  }
}

}  // namespace
}  // namespace elastimate
