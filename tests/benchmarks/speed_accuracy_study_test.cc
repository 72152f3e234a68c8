// Runs the quick study of time against accuracy, and checks it against theory.

#include <gtest/gtest.h>

#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <map>
#include <string>
#include <vector>

#include "tests/benchmarks/tables.h"
#include "tests/program.h"

namespace elastimate {
namespace {

using testing::ReadTable;
using testing::TableRow;

class SpeedAccuracyStudyLong : public testing::ProgramTest {};

// The keys are "scene/world/deviation/method".
using Points = std::map<std::string, TableRow>;

Points ReadPoints(const std::filesystem::path& path) {
  Points points;
  for (const TableRow& row : ReadTable(path)) {
    points.emplace(row.Text("scene") + "/" + row.Text("world") + "/" +
                       row.Text("displacement_deviation [1]") + "/" +
                       row.Text("method"),
                   row);
  }
  return points;
}

double YoungsModulusError(const Points& points, const std::string& key) {
  return points.at(key).Number("youngs_modulus_rms_error [1]");
}

// On the same mesh the fit of displacements is efficient.  Its mean square
// error equals the bound, within the Monte Carlo error of a sum of squares of
// normal values.
void ExpectReducedFeAtTheBound(const Points& points) {
  for (const char* deviation : {"0.001", "0.01"}) {
    const TableRow& row = points.at(std::string("cuboid/same mesh/") +
                                    deviation + "/reduced-fe order 1");
    EXPECT_EQ(row.Number("failure_rate [1]"), 0);
    const double monte_carlo = 4 * std::sqrt(2 / row.Number("trials [1]"));
    for (const char* error : {"youngs_modulus_rms_error [Cramer-Rao]",
                              "poisson_ratio_rms_error [Cramer-Rao]"}) {
      const double square = std::pow(row.Number(error), 2);
      EXPECT_GT(square, 1 - monte_carlo) << deviation << " " << error;
      EXPECT_LT(square, 1 + monte_carlo) << deviation << " " << error;
    }
  }
}

// Linear elements are too stiff for a finer world: virtual fields keep that
// error of E, and fits go on to finer elements.
void ExpectFitsToKnowTheMeshError(const Points& points) {
  for (const char* deviation : {"0.001", "0.01"}) {
    const std::string cell =
        std::string("cuboid/finer world/") + deviation + "/";
    EXPECT_GT(YoungsModulusError(points, cell + "virtual-fields degree 1"),
              0.02);
    for (const char* fit : {"reduced-fe order 1", "iterative-fe order 1"}) {
      EXPECT_LT(YoungsModulusError(points, cell + fit), 0.005) << fit;
    }
  }
}

// Quadratic elements are no model of displacements that linear ones computed.
void ExpectTheOrderOfTheMeshToWin(const Points& points) {
  for (const char* method : {"reduced-fe", "iterative-fe"}) {
    for (const char* deviation : {"0.001", "0.01"}) {
      const std::string same = std::string("cuboid/same mesh/") + deviation +
                               "/" + method + " order ";
      EXPECT_LT(YoungsModulusError(points, same + "1"),
                YoungsModulusError(points, same + "2"))
          << same;
    }
  }
}

// Both methods that fit displacements minimise the same sum of squares.
void ExpectOneMinimum(const Points& points) {
  const std::string cell = "cuboid/same mesh/0.01/";
  const double reduced =
      YoungsModulusError(points, cell + "reduced-fe order 1");
  const double iterative =
      YoungsModulusError(points, cell + "iterative-fe order 1");
  EXPECT_NEAR(reduced, iterative, 0.1 * iterative);
}

void ExpectSummary(const Points& points, const std::vector<TableRow>& summary) {
  for (const TableRow& row : summary) {
    const std::string cell = row.Text("scene") + "/" + row.Text("world") + "/" +
                             row.Text("displacement_deviation [1]") + "/";
    const std::string& cheapest = row.Text("cheapest_within_1_percent");
    EXPECT_NE(row.Text("auto_choice"), "") << cell;
    if (cheapest == "none") {
      continue;
    }
    const double time = points.at(cell + cheapest).Number("processor_time [s]");
    for (const auto& [key, point] : points) {
      if (key.find(cell) == 0 && point.Text("estimator") != "auto" &&
          point.Number("processor_time [s]") < time) {
        EXPECT_TRUE(point.Number("failure_rate [1]") > 0 ||
                    point.Number("youngs_modulus_rms_error [1]") > 0.01)
            << key;
      }
    }
  }
}

TEST_F(SpeedAccuracyStudyLong, FindsWhatTheoryPredicts) {
  Succeed("study --name=speed_accuracy --out=. --quick");
  const Points points = ReadPoints(folder_ / "speed_accuracy_points.csv");
  ExpectReducedFeAtTheBound(points);
  ExpectFitsToKnowTheMeshError(points);
  ExpectTheOrderOfTheMeshToWin(points);
  ExpectOneMinimum(points);
  ExpectSummary(points, ReadTable(folder_ / "speed_accuracy_summary.csv"));

  const std::string plot =
      std::string(ELASTIMATE_PLOT) + " '" + folder_.string() + "'";
  ASSERT_EQ(std::system(plot.c_str()), 0);
  for (const char* figure :
       {"speed_accuracy_youngs_modulus_noise_0_1_percent.svg",
        "speed_accuracy_youngs_modulus_noise_1_percent.png",
        "speed_accuracy_poisson_ratio_noise_1_percent.png"}) {
    EXPECT_TRUE(std::filesystem::exists(folder_ / figure)) << figure;
  }
}

}  // namespace
}  // namespace elastimate
