// Runs the quick paper study, and checks its trials against theory.

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <map>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "elastimate/core/equilibrium/simulated_measurement.h"
#include "elastimate/core/scene/degrees_of_freedom.h"
#include "elastimate/core/scene/loads.h"
#include "elastimate/io/examples/example_scenes.h"
#include "tests/benchmarks/tables.h"
#include "tests/bias_law.h"
#include "tests/program.h"

namespace elastimate {
namespace {

using testing::kPoissonRatioError;
using testing::kYoungsModulusError;
using testing::ReadTable;
using testing::TableRow;

constexpr const char* kDeviation = "displacement_deviation [1]";

using RowsByDeviation = std::map<double, std::vector<TableRow>>;

RowsByDeviation ByDeviation(const std::vector<TableRow>& rows,
                            const std::string& estimator) {
  RowsByDeviation groups;
  for (const TableRow& row : rows) {
    if (row.Text("estimator") == estimator) {
      groups[row.Number(kDeviation)].push_back(row);
    }
  }
  return groups;
}

void ExpectClosedFormIsExactWithoutNoise(const RowsByDeviation& closed_form) {
  for (const TableRow& row : closed_form.at(0)) {
    EXPECT_LT(std::abs(row.Number(kYoungsModulusError)), 1e-10);
    EXPECT_LT(std::abs(row.Number(kPoissonRatioError)), 1e-10);
    EXPECT_EQ(row.Text("status"), "ok");
  }
}

void ExpectTheBiasLaw(const RowsByDeviation& closed_form) {
  constexpr IsotropicElasticity kElasticity = {10e3, 0.33};
  Scene exact = CuboidScene({});
  Measure(kElasticity, exact);
  for (const auto& [deviation, rows] : closed_form) {
    SCOPED_TRACE(deviation);
    const auto [rho, noise_poisson_ratio] =
        testing::BiasLawOf(exact, deviation);
    const double expected =
        rho * (noise_poisson_ratio - kElasticity.poisson_ratio);
    double sum = 0;
    double square_sum = 0;
    for (const TableRow& row : rows) {
      const double error = row.Number(kPoissonRatioError);
      sum += error;
      square_sum += error * error;
    }
    const double count = static_cast<double>(rows.size());
    const double mean = sum / count;
    const double variance =
        std::max(square_sum / count - mean * mean, 0.0) / count;
    // The tolerance covers the Monte Carlo error, rounding, and the next order
    // of the law, of 1 / number of equations, which comes from a ratio of means
    // in place of a mean of ratios.
    EXPECT_NEAR(mean, expected,
                4 * std::sqrt(variance) + expected / 50 + 1e-12);
  }
}

// The mean square error may be below the bound only by the Monte Carlo error of
// a sum of squares of normal values.
void ExpectCramerRaoIsNotBeaten(const RowsByDeviation& groups,
                                const char* error, const char* bound) {
  for (const auto& [deviation, rows] : groups) {
    if (deviation == 0) {
      continue;
    }
    SCOPED_TRACE(deviation);
    double ratio = 0;
    for (const TableRow& row : rows) {
      ratio += std::pow(row.Number(error) / row.Number(bound), 2);
    }
    const double count = static_cast<double>(rows.size());
    EXPECT_GT(ratio / count, 1 - 4 * std::sqrt(2 / count));
  }
}

// Where its bound holds nu at the truth, 1 / E is linear in the noise, so that
// each seed has one slope.
void ExpectLinearGrowth(const RowsByDeviation& bounded) {
  std::map<std::string, std::vector<double>> slopes;
  for (const auto& [deviation, rows] : bounded) {
    for (const TableRow& row : rows) {
      if (deviation > 0 && row.Number(kPoissonRatioError) == 0) {
        const double inverse = 1 / (1 + row.Number(kYoungsModulusError));
        slopes[row.Text("seed")].push_back((inverse - 1) / deviation);
      }
    }
  }
  EXPECT_GT(slopes.size(), bounded.at(0).size() / 2);
  for (const auto& [seed, of_seed] : slopes) {
    const auto [least, greatest] =
        std::minmax_element(of_seed.begin(), of_seed.end());
    // The table has seven digits of the error, which is the slope times the
    // deviation to first order.  1 + error is rounded, too.
    EXPECT_NEAR(*least, *greatest, 1e-6 * (std::abs(*least) + 1))
        << "seed " << seed;
  }
}

void ExpectFindings(const std::vector<TableRow>& findings) {
  for (const TableRow& row : findings) {
    const std::string& claim = row.Text("claim");
    if (claim.find("improve") == std::string::npos) {
      EXPECT_EQ(row.Text("paper_method_agrees"), "yes")
          << claim << ": " << row.Text("quantity");
    }
    // Averaging lets the fit of displacements converge as 1 / sqrt(20).
    if (claim.find("do not converge") != std::string::npos) {
      EXPECT_LT(row.Number("reduced_fe [1]"), 0.5);
    }
  }
}

void ExpectMetadata(const nlohmann::json& metadata) {
  EXPECT_EQ(metadata["command"],
            ELASTIMATE_PROGRAM " study --name=paper --out=. --quick");
  for (const char* key :
       {"date", "commit", "compiler", "compiler_flags", "blas", "processor"}) {
    EXPECT_FALSE(metadata[key].get<std::string>().empty()) << key;
  }
}

class PaperStudyRemade : public testing::ProgramTest {};

TEST_F(PaperStudyRemade, FindsWhatTheoryPredicts) {
  Succeed("study --name=paper --out=. --quick");
  const std::vector<TableRow> noise = ReadTable(folder_ / "paper_noise.csv");
  const RowsByDeviation closed_form = ByDeviation(noise, "closed-form");
  ExpectClosedFormIsExactWithoutNoise(closed_form);
  ExpectTheBiasLaw(closed_form);
  const RowsByDeviation reduced_fe = ByDeviation(noise, "reduced-fe");
  ExpectCramerRaoIsNotBeaten(reduced_fe, kYoungsModulusError,
                             "youngs_modulus_cramer_rao [1]");
  ExpectCramerRaoIsNotBeaten(reduced_fe, kPoissonRatioError,
                             "poisson_ratio_cramer_rao [1]");
  const std::vector<TableRow> organ = ReadTable(folder_ / "paper_organ.csv");
  ExpectCramerRaoIsNotBeaten(ByDeviation(organ, "reduced-fe"),
                             kYoungsModulusError,
                             "youngs_modulus_cramer_rao [1]");
  ExpectLinearGrowth(ByDeviation(organ, "bounded"));
  ExpectFindings(ReadTable(folder_ / "paper_findings.csv"));

  const nlohmann::json metadata =
      nlohmann::json::parse(testing::ReadText(folder_ / "paper.json"));
  ExpectMetadata(metadata);
  const std::string plot =
      std::string(ELASTIMATE_PLOT) + " '" + folder_.string() + "'";
  ASSERT_EQ(std::system(plot.c_str()), 0);
  for (const std::string table : metadata["tables"]) {
    const std::filesystem::path csv = folder_ / table;
    EXPECT_TRUE(std::filesystem::exists(csv)) << csv;
    if (table != "paper_findings.csv" &&
        table != "paper_noise_prediction.csv") {
      EXPECT_TRUE(std::filesystem::exists(
          std::filesystem::path(csv).replace_extension(".svg")));
      EXPECT_TRUE(std::filesystem::exists(
          std::filesystem::path(csv).replace_extension(".png")));
    }
  }
}

}  // namespace
}  // namespace elastimate
