// Runs the quick stability study, and checks its trials against theory.

#include <gtest/gtest.h>

#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <map>
#include <string>
#include <tuple>
#include <vector>

#include "tests/benchmarks/tables.h"
#include "tests/program.h"

namespace elastimate {
namespace {

using testing::kPoissonRatioError;
using testing::kYoungsModulusError;
using testing::ReadTable;
using testing::TableRow;

// The numbers have seven digits, and 1 was subtracted from some of them.
constexpr double kTableRounding = 1e-6;

/// The key of a trial is its factor, level, estimator and seed.
using Key = std::tuple<std::string, std::string, std::string, std::string>;
using Trials = std::map<Key, TableRow>;

Trials Index(const std::vector<TableRow>& rows) {
  Trials trials;
  for (const TableRow& row : rows) {
    trials.emplace(Key{row.Text("factor"), row.Text("level"),
                       row.Text("estimator"), row.Text("seed")},
                   row);
  }
  return trials;
}

void ExpectExactDataGiveTheTruth(const Trials& trials) {
  int count = 0;
  for (const auto& [key, row] : trials) {
    const auto& [factor, level, estimator, seed] = key;
    if (factor == "noise [%]" && level == "0") {
      SCOPED_TRACE(estimator);
      EXPECT_EQ(row.Text("status"), "ok");
      EXPECT_LT(std::abs(row.Number(kYoungsModulusError)), 1e-10);
      EXPECT_LT(std::abs(row.Number(kPoissonRatioError)), 1e-10);
      ++count;
    }
  }
  EXPECT_GT(count, 0);
}

// At the first level of each factor the model is right, and the noise is 1 % or
// none.
void ExpectHonestyWhereNothingIsWrong(const std::vector<TableRow>& rows) {
  std::map<std::string, std::string> first_levels;
  for (const TableRow& row : rows) {
    const std::string& first =
        first_levels.emplace(row.Text("factor"), row.Text("level"))
            .first->second;
    if (row.Text("level") == first) {
      EXPECT_NE(row.Text("outcome"), "dishonest")
          << row.Text("factor") << ", " << row.Text("estimator");
    }
  }
}

// An inclusion leaves a residual, which must not be taken for the error of the
// elements.
void ExpectNoElementsToExplainAnInclusion(const Trials& trials) {
  int count = 0;
  for (const auto& [key, row] : trials) {
    const auto& [factor, level, estimator, seed] = key;
    if (factor == "inclusion stiffness [1]" && estimator != "auto") {
      EXPECT_NE(row.Text("outcome"), "dishonest") << level << ", " << estimator;
      ++count;
    }
  }
  EXPECT_GT(count, 0);
}

// E is proportional to the force, and nu does not depend on it.
void ExpectTheForceScalesE(const Trials& trials) {
  int count = 0;
  for (const auto& [key, row] : trials) {
    const auto& [factor, level, estimator, seed] = key;
    if (factor != "force scale [1]") {
      continue;
    }
    SCOPED_TRACE(estimator + ", scale " + level);
    const TableRow& right = trials.at({factor, "1", estimator, seed});
    const double scale = std::stod(level);
    EXPECT_NEAR((1 + row.Number(kYoungsModulusError)) / scale,
                1 + right.Number(kYoungsModulusError), kTableRounding);
    EXPECT_NEAR(row.Number(kPoissonRatioError),
                right.Number(kPoissonRatioError), kTableRounding);
    EXPECT_EQ(row.Text("status"), right.Text("status"));
    ++count;
  }
  EXPECT_GT(count, 0);
}

// The inclusion of this level has the material of the block, so its trials must
// be those of the base scene.  A dense solution of two materials measured it.
void ExpectInclusionOfTheSameMaterialIsNone(const Trials& trials) {
  int count = 0;
  for (const auto& [key, row] : trials) {
    const auto& [factor, level, estimator, seed] = key;
    if (factor == "inclusion stiffness [1]" && level == "1") {
      SCOPED_TRACE(estimator);
      const TableRow& base = trials.at({"load", "oblique", estimator, seed});
      EXPECT_NEAR(row.Number(kYoungsModulusError),
                  base.Number(kYoungsModulusError), kTableRounding);
      EXPECT_NEAR(row.Number(kPoissonRatioError),
                  base.Number(kPoissonRatioError), kTableRounding);
      ++count;
    }
  }
  EXPECT_GT(count, 0);
}

double SquareSum(const Trials& trials, const std::string& estimator) {
  double sum = 0;
  for (const auto& [key, row] : trials) {
    if (std::get<0>(key) == "outliers [% of nodes]" &&
        std::get<1>(key) == "10" && std::get<2>(key) == estimator) {
      sum += std::pow(row.Number(kYoungsModulusError), 2);
      sum += std::pow(row.Number(kPoissonRatioError), 2);
    }
  }
  EXPECT_GT(sum, 0) << estimator;
  return sum;
}

// Fits leave outliers out, which is no worse than a loss.
void ExpectFitsWithstandOutliers(const Trials& trials) {
  for (const std::string estimator : {"reduced-fe", "iterative-fe"}) {
    EXPECT_LT(SquareSum(trials, estimator),
              1.1 * SquareSum(trials, estimator + " huber"));
  }
}

// Estimators of the force balance need the displacement of every node; those
// that compute displacements need supports.
void ExpectUnsupportedWhereDataAreMissing(const std::vector<TableRow>& rows) {
  for (const TableRow& row : rows) {
    const std::string& estimator = row.Text("estimator");
    if (row.Text("factor") == "observed nodes" && row.Text("level") == "5") {
      EXPECT_EQ(row.Text("status") == "unsupported",
                estimator == "closed-form" || estimator == "bounded" ||
                    estimator == "virtual-fields")
          << estimator;
    }
    if (row.Text("factor") == "support nodes left free [%]" &&
        row.Text("level") == "100" &&
        (estimator == "reduced-fe" || estimator == "iterative-fe")) {
      EXPECT_EQ(row.Text("status"), "unsupported") << estimator;
    }
  }
}

// This is the definition in the README, computed from columns of the table.
bool IsDishonest(const TableRow& row) {
  const auto or_zero = [](double value) {
    return std::isnan(value) ? 0. : value;
  };
  const double e = std::abs(row.Number(kYoungsModulusError));
  const double nu_error = row.Number(kPoissonRatioError);
  const double nu = row.Number("true_poisson_ratio [1]");
  return row.Text("status") == "ok" &&
         row.Text("factor") != "force scale [1]" &&
         row.Number("element_order [1]") == 1 &&
         ((e > 0.1 &&
           e > 3 * or_zero(row.Number("youngs_modulus_standard_error [1]"))) ||
          (std::abs(nu_error) > 0.03 &&
           std::abs(nu_error) >
               3 * or_zero(row.Number("poisson_ratio_standard_error [1]")) &&
           !(row.Number("poisson_ratio_lower [1]") <= nu &&
             nu <= row.Number("poisson_ratio_upper [1]"))));
}

void ExpectCellsAddUpTrials(const std::vector<TableRow>& rows,
                            const std::vector<TableRow>& cells) {
  using CellKey = std::tuple<std::string, std::string, std::string>;
  const auto key = [](const TableRow& row) {
    return CellKey{row.Text("factor"), row.Text("level"),
                   row.Text("estimator")};
  };
  std::map<CellKey, int> num_dishonest;
  std::map<CellKey, int> num_failed;
  for (const TableRow& row : rows) {
    num_dishonest[key(row)] += IsDishonest(row);
    num_failed[key(row)] += row.Text("status") != "ok";
    EXPECT_EQ(row.Text("outcome") == "dishonest", IsDishonest(row));
  }
  EXPECT_EQ(num_failed.size(), cells.size());
  for (const TableRow& cell : cells) {
    const double trials = cell.Number("trials [1]");
    EXPECT_NEAR(cell.Number("dishonest_share [1]") * trials,
                num_dishonest.at(key(cell)), kTableRounding * trials);
    EXPECT_NEAR(cell.Number("failure_rate [1]") * trials,
                num_failed.at(key(cell)), kTableRounding * trials);
  }
}

class StabilityStudyRemade : public testing::ProgramTest {};

TEST_F(StabilityStudyRemade, FindsWhatTheoryPredicts) {
  Succeed("study --name=stability --out=. --quick");
  const std::vector<TableRow> rows = ReadTable(folder_ / "stability.csv");
  const Trials trials = Index(rows);
  ExpectExactDataGiveTheTruth(trials);
  ExpectHonestyWhereNothingIsWrong(rows);
  ExpectTheForceScalesE(trials);
  ExpectInclusionOfTheSameMaterialIsNone(trials);
  ExpectNoElementsToExplainAnInclusion(trials);
  ExpectFitsWithstandOutliers(trials);
  ExpectUnsupportedWhereDataAreMissing(rows);
  ExpectCellsAddUpTrials(rows, ReadTable(folder_ / "stability_cells.csv"));

  const std::string plot =
      std::string(ELASTIMATE_PLOT) + " '" + folder_.string() + "'";
  ASSERT_EQ(std::system(plot.c_str()), 0);
  for (const char* chart : {"stability_cells.svg", "stability_cells.png"}) {
    EXPECT_TRUE(std::filesystem::exists(folder_ / chart)) << chart;
  }
}

}  // namespace
}  // namespace elastimate
