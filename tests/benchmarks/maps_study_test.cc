// Runs the quick maps study, and checks its tables against what is known of
// maps.

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

class MapsStudyRemade : public testing::ProgramTest {};

TEST_F(MapsStudyRemade, HasTheStagesTheContrastAndTheTimes) {
  Succeed("study --name=maps --out=. --quick");
  int num_stages = 0;
  for (const TableRow& row : ReadTable(folder_ / "maps_stages.csv")) {
    const std::string stage = row.Text("stage");
    const bool is_inclusion = row.Text("specimen") == "inclusion";
    const double error = row.Number("error [1]");
    ++num_stages;
    if (stage == "verdict") {
      EXPECT_EQ(row.Text("verdict"), is_inclusion ? "regions" : "field");
      EXPECT_LT(error, is_inclusion ? 0.05 : 0.2);
    } else if (stage == "local") {
      if (row.Number("displacement_deviation [1]") > 0.005) {
        EXPECT_GT(error, 1);
      }
    } else if (stage == "smooth") {
      EXPECT_LT(error, 0.5);
    }
  }
  EXPECT_EQ(num_stages, 2 * 2 * 5);
  for (const TableRow& row : ReadTable(folder_ / "maps_contrast.csv")) {
    const double part = row.Number("part_of_contrast [1]");
    EXPECT_LT(part, 1.1);
    if (row.Number("diameter_over_resolution_length [1]") > 4) {
      EXPECT_GT(part, 0.8);
    }
  }
  // Noise hides parameters, unless there are as many as measurements allow.
  double last = 0;
  double last_elements = 0;
  for (const TableRow& row : ReadTable(folder_ / "maps_time.csv")) {
    const double supported = row.Number("supported_parameters [1]");
    EXPECT_LT(supported, row.Number("elements [1]"));
    if (row.Number("elements [1]") == last_elements) {
      EXPECT_LT(supported, 1.001 * last);
    }
    last = supported;
    last_elements = row.Number("elements [1]");
  }
  const std::string plot =
      std::string(ELASTIMATE_PLOT) + " '" + folder_.string() + "'";
  ASSERT_EQ(std::system(plot.c_str()), 0);
  for (const std::string name : {"maps_stages", "maps_contrast", "maps_time"}) {
    EXPECT_TRUE(std::filesystem::exists(folder_ / (name + ".png"))) << name;
  }
}

}  // namespace
}  // namespace elastimate
