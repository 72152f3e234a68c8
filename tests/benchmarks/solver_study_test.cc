// Runs the quick study of the solvers.

#include <gtest/gtest.h>

#include <map>
#include <string>
#include <vector>

#include "elastimate/core/solvers/multigrid.h"
#include "tests/benchmarks/tables.h"
#include "tests/program.h"

namespace elastimate {
namespace {

using testing::ReadTable;
using testing::TableRow;

class SolverStudy : public testing::ProgramTest {};

TEST_F(SolverStudy, MeasuresEverySolver) {
  Succeed("study --name=solvers --out=. --quick");
  std::map<std::string, std::vector<TableRow>> by_solver;
  for (const TableRow& row : ReadTable(folder_ / "solvers.csv")) {
    EXPECT_EQ(row.Text("outcome"), "measured");
    EXPECT_GT(row.Number("factorization_time [s]"), 0);
    EXPECT_GT(row.Number("solve_time [s]"), 0);
    EXPECT_GT(row.Number("peak_memory [MiB]"), 0);
    by_solver[row.Text("solver")].push_back(row);
  }
  // Cubes of 6^3 linear and 4^3 quadratic cells, held at the bottom, and an
  // organ.
  ASSERT_EQ(by_solver["cholmod"].size(), 3U);
  ASSERT_EQ(by_solver["cholesky"].size(), 6U);
  EXPECT_EQ(by_solver["cholmod"][0].Number("free_degrees_of_freedom [1]"),
            3 * 7 * 7 * 6);
  for (const TableRow& row : by_solver["cholesky"]) {
    EXPECT_EQ(row.Number("iterations [1]"), 0);
  }
  // The ordering of the nodes is about as good as that of all components.
  for (int i = 0; i < 3; ++i) {
    const std::string flops = "factorization_flops [1]";
    EXPECT_LE(by_solver["cholesky"][2 * i].Number(flops),
              1.5 * by_solver["cholmod"][i].Number(flops));
  }
  if (HasMultigrid()) {
    ASSERT_EQ(by_solver["multigrid"].size(), 6U);
    for (const TableRow& row : by_solver["multigrid"]) {
      EXPECT_GT(row.Number("rough_iterations [1]"), 0);
      EXPECT_GT(row.Number("iterations [1]"),
                row.Number("rough_iterations [1]"));
    }
  }
}

}  // namespace
}  // namespace elastimate
