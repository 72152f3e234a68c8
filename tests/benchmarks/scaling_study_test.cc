// Runs the quick scaling study.

#include <gtest/gtest.h>

#include <cstdlib>
#include <filesystem>
#include <map>
#include <string>
#include <vector>

#include "elastimate/estimators/registry.h"
#include "tests/benchmarks/tables.h"
#include "tests/program.h"

namespace elastimate {
namespace {

using testing::ReadTable;
using testing::TableRow;

class ScalingStudy : public testing::ProgramTest {};

TEST_F(ScalingStudy, MeasuresEveryEstimator) {
  Succeed("study --name=scaling --out=. --quick");
  std::map<std::string, std::vector<TableRow>> by_estimator;
  for (const TableRow& row : ReadTable(folder_ / "scaling.csv")) {
    EXPECT_EQ(row.Text("outcome"), "measured");
    if (row.Text("body") == "cube") {
      by_estimator[row.Text("estimator")].push_back(row);
    }
  }
  for (const std::string_view view : EstimatorNames()) {
    const std::string name(view);
    SCOPED_TRACE(name);
    const std::vector<TableRow>& rows = by_estimator[name];
    ASSERT_EQ(rows.size(), 2U);
    EXPECT_LT(rows[0].Number("tetrahedra [1]"),
              rows[1].Number("tetrahedra [1]"));
    for (const TableRow& row : rows) {
      EXPECT_GT(row.Number("time [s]"), 0);
      EXPECT_GT(row.Number("processor_time [s]"), 0);
      EXPECT_GT(row.Number("repetitions [1]"), 0);
      EXPECT_GT(row.Number("peak_memory [MiB]"), 0);
    }
    // A factor has more entries for each node of a larger cube, so memory and
    // time must grow.  The memory of the other estimators is hidden by what a
    // process keeps of freed memory.
    if (name == "reduced-fe" || name == "iterative-fe") {
      EXPECT_EQ(rows[0].Text("status"), "ok");
      EXPECT_GT(rows[0].Number("factorizations [1]"), 0);
      EXPECT_GT(rows[1].Number("own_memory [MiB]"),
                rows[0].Number("own_memory [MiB]"));
      EXPECT_GT(rows[1].Number("processor_time [s]"),
                rows[0].Number("processor_time [s]"));
    }
  }
  EXPECT_EQ(by_estimator.size(), EstimatorNames().size());
  EXPECT_EQ(ReadTable(folder_ / "scaling_slopes.csv").size(),
            2 * EstimatorNames().size());

  const std::string plot =
      std::string(ELASTIMATE_PLOT) + " '" + folder_.string() + "'";
  ASSERT_EQ(std::system(plot.c_str()), 0);
  EXPECT_TRUE(std::filesystem::exists(folder_ / "scaling.svg"));
  EXPECT_TRUE(std::filesystem::exists(folder_ / "scaling.png"));
}

}  // namespace
}  // namespace elastimate
