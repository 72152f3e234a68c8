// Runs the quick materials study, and holds it against what has to be.

#include <gtest/gtest.h>

#include <cmath>
#include <cstdlib>
#include <string>
#include <vector>

#include "tests/benchmarks/tables.h"
#include "tests/program.h"

namespace elastimate {
namespace {

using testing::ReadTable;
using testing::TableRow;

constexpr char kBoundOfE[] = "youngs_modulus_cramer_rao [1]";
constexpr char kPrediction[] = "prediction_error [1]";

class MaterialsStudy : public testing::ProgramTest {
 protected:
  // Of the rows of one factor by iterative-fe, in their order.
  std::vector<TableRow> Of(const std::string& factor) const {
    std::vector<TableRow> own;
    for (const TableRow& row : rows_) {
      if (row.Text("factor") == factor &&
          row.Text("estimator") == "iterative-fe") {
        own.push_back(row);
      }
    }
    EXPECT_GT(own.size(), 2U) << factor;
    return own;
  }

  void ExpectTrueErrors() const {
    for (const TableRow& row : rows_) {
      SCOPED_TRACE(row.Text("factor") + " " + row.Text("level"));
      const double score = row.Number("error_over_cramer_rao [1]");
      if (row.Text("estimator") == "iterative-fe" && std::isfinite(score)) {
        // The mean of chi^2 of two degrees of freedom or more is below 16 but
        // for 1e-7.
        EXPECT_LT(score, 4);
      }
    }
    // Wrong regions are told.
    for (const TableRow& row : Of("wrong regions")) {
      EXPECT_EQ(row.Number("usable_share [1]"),
                row.Text("assumption") == "right" ? 1 : 0)
          << row.Text("assumption");
    }
  }

  void ExpectBoundsToFollow() const {
    // Errors grow with the number of regions, and as an inclusion shrinks.
    const std::vector<TableRow> regions = Of("regions");
    for (std::size_t i = 1; i < regions.size(); ++i) {
      EXPECT_GT(regions[i].Number(kBoundOfE), regions[i - 1].Number(kBoundOfE));
      EXPECT_LT(regions[i].Number("least_energy_share [1]"),
                regions[i - 1].Number("least_energy_share [1]"));
    }
    const std::vector<TableRow> inclusions =
        Of("width of an inclusion [cells]");
    EXPECT_GT(inclusions.front().Number(kBoundOfE),
              4 * inclusions.back().Number(kBoundOfE));
    // The bound is proportional to the noise.
    const std::vector<TableRow> noise = Of("noise [%]");
    EXPECT_NEAR(noise[2].Number(kBoundOfE) / noise[0].Number(kBoundOfE), 50,
                1e-3);
    // Each load case says more.
    const std::vector<TableRow> cases = Of("load cases at 5 % noise");
    EXPECT_LT(cases[1].Number(kBoundOfE), cases[0].Number(kBoundOfE));
    EXPECT_LT(cases[2].Number(kBoundOfE), cases[1].Number(kBoundOfE));
  }

  void ExpectTooFewAndTooManyToShow() const {
    const std::vector<TableRow> models = Of("regions of the model");
    ASSERT_EQ(models.size(), 12U);  // Four at each of three noises.
    for (std::size_t i = 0; i < models.size(); i += 4) {
      const TableRow& right = models[i + 2];
      EXPECT_EQ(right.Text("assumption"), "right");
      EXPECT_GT(models[i].Number(kPrediction), 10 * right.Number(kPrediction));
      EXPECT_GT(models[i].Number(kPrediction),
                models[i + 1].Number(kPrediction));
      EXPECT_EQ(models[i].Number("usable_share [1]"), 0);
      EXPECT_GT(models[i + 3].Number(kBoundOfE), 2 * right.Number(kBoundOfE));
    }
  }

  std::vector<TableRow> rows_;
};

TEST_F(MaterialsStudy, FindsWhatFollowsFromTheory) {
  Succeed("study --name=materials --out=. --quick");
  rows_ = ReadTable(folder_ / "materials_cells.csv");
  ExpectTrueErrors();
  ExpectBoundsToFollow();
  ExpectTooFewAndTooManyToShow();
}

}  // namespace
}  // namespace elastimate
