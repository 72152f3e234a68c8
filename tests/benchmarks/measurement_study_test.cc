// Runs the quick measurement study, and checks its tables against theory.

#include <gtest/gtest.h>

#include <cstdlib>
#include <string>
#include <vector>

#include "tests/benchmarks/tables.h"
#include "tests/program.h"

namespace elastimate {
namespace {

using testing::ReadTable;
using testing::TableRow;

const TableRow& RowOfLevel(const std::vector<TableRow>& rows,
                           const std::string& factor, const std::string& level,
                           const std::string& assumption) {
  for (const TableRow& row : rows) {
    if (row.Text("factor") == factor && row.Text("level") == level &&
        row.Text("assumption") == assumption) {
      return row;
    }
  }
  ADD_FAILURE() << factor << " " << level << " " << assumption;
  return rows.front();
}

// With ten cells a side, noise of 4 um is too large to find much.  Noise that
// neighbours share over two spacings is taken for a fault of the model.
bool IsTooMuchForTenCells(const TableRow& row) {
  return row.Text("level") == "4" ||
         (row.Text("factor") == "correlation length [spacings]" &&
          row.Text("level") == "2");
}

class MeasurementStudy : public testing::ProgramTest {};

TEST_F(MeasurementStudy, TellsRightFromWrong) {
  Succeed("study --name=measurement --out=. --quick");
  const std::vector<TableRow> rows =
      ReadTable(folder_ / "measurement_cells.csv");
  const std::string error = "youngs_modulus_root_mean_square_error [1]";
  for (const TableRow& row : rows) {
    SCOPED_TRACE(row.Text("factor") + " " + row.Text("level") + " " +
                 row.Text("assumption"));
    if (row.Text("assumption") != "right") {
      continue;
    }
    EXPECT_EQ(row.Number("dishonest_share [1]"), 0);
    if (!IsTooMuchForTenCells(row)) {
      EXPECT_GE(row.Number("usable_share [1]"), 0.5);
      // A mean over four trials: chi^2 of 4 degrees of freedom is below 25,
      // except with a probability of 5e-5.
      EXPECT_LT(row.Number(error),
                2.5 * row.Number("youngs_modulus_standard_error [1]"));
    }
  }
  // Five per cent of the 121 nodes are 6.
  EXPECT_NEAR(
      RowOfLevel(rows, "outliers [%]", "5", "right").Number("outliers [1]"), 6,
      1);
  // A rigid grip does not pull evenly.
  EXPECT_GT(
      RowOfLevel(rows, "ends", "rigid grip", "uniform traction").Number(error),
      4 * RowOfLevel(rows, "ends", "rigid grip", "right").Number(error));
  // The ends that are taken as exact were measured with noise.
  const TableRow& exact =
      RowOfLevel(rows, "ends", "measured", "taken as exact");
  EXPECT_GT(exact.Number(error),
            3 * exact.Number("youngs_modulus_standard_error [1]"));
  // The camera moved by a hundredth of a millimetre, which the scene denies.
  EXPECT_EQ(RowOfLevel(rows, "camera motion [mm]", "0.01", "fixed camera")
                .Number("usable_share [1]"),
            0);
  // Where neighbours share noise, a jackknife sees more than independent noise
  // would make, though it knows nothing of the correlation.  It states up to
  // twice too much, since the blocks at the ends know most.
  for (const TableRow& row : ReadTable(folder_ / "measurement_jackknife.csv")) {
    if (row.Text("level") == "0.5" || row.Text("level") == "1") {
      EXPECT_GT(row.Number("trials [1]"), 0);
      const double jackknife = row.Number("youngs_modulus_jackknife_error [1]");
      EXPECT_GT(jackknife, row.Number("youngs_modulus_noise_error [1]"));
      const double ratio =
          row.Number("youngs_modulus_standard_error [1]") / jackknife;
      EXPECT_GT(ratio, 0.25);
      EXPECT_LT(ratio, 1.5);
    }
  }
}

}  // namespace
}  // namespace elastimate
