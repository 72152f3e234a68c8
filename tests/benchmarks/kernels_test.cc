// Runs the quick timing of the kernels.

#include <gtest/gtest.h>

#include <set>
#include <string>

#include "tests/benchmarks/tables.h"
#include "tests/program.h"

namespace elastimate {
namespace {

using testing::ReadTable;
using testing::TableRow;

class Kernels : public testing::ProgramTest {};

TEST_F(Kernels, QuickRunTimesEachKernelAtEachSize) {
  const testing::ProgramRun run = Run("kernels --out=. --quick");
  // How fast a busy machine is, is not for a test to judge.
  EXPECT_TRUE(run.exit_code == 0 || run.exit_code == 1) << run.errors;
  EXPECT_NE(run.output.find("naive / vector"), std::string::npos);
  std::set<std::string> kernels;
  std::set<std::string> numberings;
  std::set<double> sizes;
  for (const TableRow& row : ReadTable(folder_ / "kernels.csv")) {
    kernels.insert(row.Text("kernel"));
    numberings.insert(row.Text("numbering"));
    sizes.insert(row.Number("tetrahedra [1]"));
    EXPECT_GT(row.Number("time_per_tetrahedron_and_column [ns]"), 0);
    const std::string kernel = row.Text("kernel");
    if (kernel != "closed-form" && kernel.rfind("further", 0) != 0) {
      EXPECT_GT(row.Number("memory_bandwidth_fraction [1]"), 0);
      EXPECT_GT(row.Number("peak_flops_fraction [1]"), 0);
    }
  }
  kernels.erase("AVX2");  // Only where the processor has AVX-512.
  EXPECT_EQ(kernels, (std::set<std::string>{
                         "naive", "scalar", "vector", "K from H and J",
                         "closed-form", "further closed-form",
                         "further virtual-fields", "further reduced-fe"}));
  EXPECT_NE(run.output.find("closed-form, further measurement / pass"),
            std::string::npos);
  EXPECT_EQ(numberings,
            (std::set<std::string>{"natural", "random", "reordered"}));
  EXPECT_EQ(sizes, (std::set<double>{10985, 98415}));
  std::set<std::string> kinds;
  for (const TableRow& row : ReadTable(folder_ / "kernels_large_strains.csv")) {
    kinds.insert(row.Text("kind"));
    EXPECT_GT(row.Number("ratio_of_forces [1]"), 0);
    EXPECT_GT(row.Number("ratio_of_tangents [1]"), 0);
  }
  EXPECT_EQ(kinds.size(), 9U);
  const auto metadata =
      nlohmann::json::parse(testing::ReadText(folder_ / "kernels.json"));
  EXPECT_TRUE(metadata.contains("commit"));
  EXPECT_TRUE(metadata["parameters"].contains("machine"));
  EXPECT_EQ(metadata["tables"][0], "kernels.csv");
}

}  // namespace
}  // namespace elastimate
