// Runs the quick study of large deformations, and checks its tables against
// what follows from theory.

#include <gtest/gtest.h>

#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <string>
#include <vector>

#include "tests/benchmarks/tables.h"
#include "tests/program.h"

namespace elastimate {
namespace {

using testing::ReadTable;
using testing::TableRow;

class LargeDeformationStudy : public testing::ProgramTest {
 protected:
  void ExpectBias() const {
    for (const TableRow& row :
         ReadTable(folder_ / "large_deformation_bias.csv")) {
      SCOPED_TRACE(row.Text("deformation") + " of " + row.Text("law") + " by " +
                   row.Text("size [degrees or %]") + ", " + row.Text("fit"));
      const double of_modulus = row.Number("ln_youngs_modulus_error [1]");
      const double of_ratio = row.Number("poisson_ratio_error [1]");
      if (row.Text("fit").rfind("auto", 0) == 0) {
        continue;
      }
      if (row.Text("fit") == "large strains") {
        EXPECT_EQ(row.Text("status"), "ok");
        EXPECT_NEAR(of_modulus, 0, 1e-5);
        EXPECT_NEAR(of_ratio, 0, 1e-5);
        continue;
      }
      // The end moves less far across than small strains say, and a bar of the
      // neo-Hookean law gets longer, one of St Venant and Kirchhoff shorter.
      const bool looks_soft = row.Text("deformation") == "stretch" &&
                              row.Text("law") == "neo_hookean";
      EXPECT_GT(looks_soft ? -of_modulus : of_modulus, 0.003);
    }
  }

  void ExpectCells() const {
    int num_of_fits = 0;
    for (const TableRow& row :
         ReadTable(folder_ / "large_deformation_cells.csv")) {
      SCOPED_TRACE(row.Text("rotation [degrees]") + " degrees, " +
                   row.Text("estimator"));
      EXPECT_GT(row.Number("time [s]"), 0);
      EXPECT_EQ(row.Number("dishonest_share [1]"), 0);
      if (row.Text("estimator") == "iterative-fe") {
        ++num_of_fits;
        EXPECT_EQ(row.Number("usable_share [1]"), 1);
        // The mean of the squares of four errors, for which chi^2 of four
        // degrees of freedom exceeds 36 with a probability of 3e-7.
        EXPECT_LT(row.Number("error_over_cramer_rao [1]"), 3);
      }
    }
    EXPECT_EQ(num_of_fits, 2);
  }

  void ExpectLimits() const {
    for (const TableRow& row :
         ReadTable(folder_ / "large_deformation_limits.csv")) {
      SCOPED_TRACE(row.Text("specimen") + " of " + row.Text("law") + ", load " +
                   row.Text("load_over_limit [1]"));
      // Beyond a limit, the reason that is told may be another one, but there
      // is one.
      EXPECT_EQ(row.Text("found") == "equilibrium",
                row.Text("expected") == "equilibrium");
      if (row.Text("found") == "equilibrium") {
        EXPECT_EQ(row.Text("is_right"), "yes");
      }
      EXPECT_NEAR(row.Number("reached_share [1]"),
                  row.Number("expected_share [1]"), 0.05);
    }
  }
};

TEST_F(LargeDeformationStudy, FindsWhatFollowsFromTheory) {
  Succeed("study --name=large_deformation --out=. --quick");
  ExpectBias();
  ExpectCells();
  ExpectLimits();

  const std::string plot =
      std::string(ELASTIMATE_PLOT) + " '" + folder_.string() + "'";
  ASSERT_EQ(std::system(plot.c_str()), 0);
  for (const std::string name :
       {"large_deformation_bias", "large_deformation_cells",
        "large_deformation_cost"}) {
    EXPECT_TRUE(std::filesystem::exists(folder_ / (name + ".png"))) << name;
  }
}

}  // namespace
}  // namespace elastimate
