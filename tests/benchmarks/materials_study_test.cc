// Runs the quick materials study, and checks its table against what follows
// from theory.

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

constexpr char kBoundOfE[] = "stiffness_cramer_rao [1]";
constexpr char kPrediction[] = "prediction_error [1]";
constexpr char kScore[] = "error_over_cramer_rao [1]";

class MaterialsStudyRemade : public testing::ProgramTest {
 protected:
  std::vector<TableRow> By(const std::string& estimator) const {
    std::vector<TableRow> own;
    for (const TableRow& row : rows_) {
      if (row.Text("estimator") == estimator) {
        own.push_back(row);
      }
    }
    EXPECT_GT(own.size(), 2U) << estimator;
    return own;
  }

  // Returns the rows of one factor by iterative-fe, in their order.
  std::vector<TableRow> Of(const std::string& factor) const {
    std::vector<TableRow> own;
    for (const TableRow& row : By("iterative-fe")) {
      if (row.Text("factor") == factor) {
        own.push_back(row);
      }
    }
    EXPECT_GT(own.size(), 2U) << factor;
    return own;
  }

  void ExpectTrueErrors() const {
    const std::vector<TableRow> iterative = By("iterative-fe");
    const std::vector<TableRow> reduced = By("reduced-fe");
    ASSERT_EQ(iterative.size(), reduced.size());
    for (std::size_t i = 0; i < iterative.size(); ++i) {
      const TableRow& row = iterative[i];
      SCOPED_TRACE(row.Text("factor") + " " + row.Text("level"));
      const double score = row.Number(kScore);
      EXPECT_EQ(std::isfinite(score), std::isfinite(reduced[i].Number(kScore)));
      if (std::isfinite(score)) {
        // The mean of the chi^2 of two degrees of freedom or more is below 16,
        // except with a probability of 1e-7.
        EXPECT_LT(score, 4);
        // Both estimators find the same minimum, to a tenth of a standard
        // error.
        EXPECT_NEAR(reduced[i].Number(kScore), score, 0.1);
      }
    }
  }

  void ExpectWrongModelsToBeTold() const {
    for (const TableRow& row : Of("wrong regions")) {
      EXPECT_EQ(row.Number("usable_share [1]"),
                row.Text("assumption") == "right" ? 1 : 0)
          << row.Text("assumption");
    }
    int num_of_wrong_laws = 0;
    for (const TableRow& row : By("iterative-fe")) {
      const std::string factor = row.Text("factor");
      if (factor == "axis off by [degrees]" ||
          factor == "E_L / E_T by E and nu") {
        EXPECT_EQ(row.Number("usable_share [1]"), 0) << factor;
        ++num_of_wrong_laws;
      }
    }
    EXPECT_EQ(num_of_wrong_laws, 2);
  }

  void ExpectBoundsToFollow() const {
    // Errors grow with the number of regions, and they grow as an inclusion
    // shrinks.
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
    // Each further load case adds information, so the bound falls.
    const std::vector<TableRow> cases = Of("load cases at 5 % noise");
    EXPECT_LT(cases[1].Number(kBoundOfE), cases[0].Number(kBoundOfE));
    EXPECT_LT(cases[2].Number(kBoundOfE), cases[1].Number(kBoundOfE));
  }

  void ExpectTooFewAndTooManyToShow() const {
    for (const std::string factor :
         {"regions of the model", "law of the model"}) {
      std::vector<TableRow> models = Of(factor);
      while (models.back().Number("noise [1]") >
             models[0].Number("noise [1]")) {
        models.pop_back();
      }
      std::size_t right = 0;
      while (models.at(right).Text("assumption") != "right") {
        ++right;
      }
      for (std::size_t i = 0; i < right; ++i) {
        EXPECT_EQ(models[i].Text("assumption"), "too few");
        EXPECT_EQ(models[i].Number("usable_share [1]"), 0);
        EXPECT_GT(models[i].Number(kPrediction),
                  10 * models[right].Number(kPrediction));
      }
      EXPECT_EQ(models.back().Text("assumption"), "too many");
      EXPECT_GT(models.back().Number(kBoundOfE),
                2 * models[right].Number(kBoundOfE));
    }
  }

  // Where virtual fields give a bad start, a plain descent from there takes
  // hundreds of factorisations.
  void ExpectFewFactorizations() const {
    for (const TableRow& row : By("iterative-fe")) {
      EXPECT_LT(row.Number("factorizations [1]"), 60)
          << row.Text("factor") << " " << row.Text("level");
    }
  }

  void ExpectMerging() const {
    for (const TableRow& row : rows_) {
      // At 5 % noise the data do not tell the regions of the right model apart,
      // so these are merged; only the other rows are checked.
      if (row.Text("estimator") == "iterative-fe merged" &&
          row.Number("noise [1]") < 0.05) {
        const double left = row.Number("estimated_parameters [1]");
        const double of_model = row.Number("parameters [1]");
        if (row.Text("assumption") == "right") {
          EXPECT_EQ(left, of_model);
        } else {
          EXPECT_LT(left, of_model);
        }
      }
    }
  }

  std::vector<TableRow> rows_;
};

TEST_F(MaterialsStudyRemade, FindsWhatFollowsFromTheory) {
  Succeed("study --name=materials --out=. --quick");
  rows_ = ReadTable(folder_ / "materials_cells.csv");
  ExpectTrueErrors();
  ExpectWrongModelsToBeTold();
  ExpectBoundsToFollow();
  ExpectTooFewAndTooManyToShow();
  ExpectFewFactorizations();
  ExpectMerging();
}

}  // namespace
}  // namespace elastimate
