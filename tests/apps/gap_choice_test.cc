// Gaps between the points of a camera, of which displacements decide whether
// the camera lost points or the specimen ends there.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <iomanip>
#include <nlohmann/json.hpp>
#include <random>
#include <sstream>
#include <string>

#include "tests/program.h"

namespace elastimate {
namespace {

using ::testing::HasSubstr;

using IsThere = std::function<bool(double x, double y)>;

class GapChoice : public testing::ProgramTest {
 protected:
  static constexpr double kTrueModulus = 2000;

  // A strip of 20 x 5 with points at a spacing of .5.
  void WriteScene(const std::string& points, const std::string& gaps,
                  const std::string& case_of) const {
    testing::WriteText(folder_ / "scene.json",
                       R"({
      "model": "plane_stress", "thickness": 1, "mesh": {"points": ")" +
                           points + R"(", "margin": 0)" + gaps + R"(},
      "supports": [ {"nodes": {"box": [[0, 0], [0, 5]]})" +
                           case_of + "}]}]}");
  }

  // Pulls a specimen that ends where `is_specimen` is false, and writes its
  // displacements at the points that a camera did not lose, with noise.
  void Measure(const IsThere& is_specimen, const IsThere& is_seen,
               double noise_sd = 1e-3) const {
    std::ostringstream grid;
    grid << "x,y,ux,uy\n";
    for (int i = 0; i <= 40; ++i) {
      for (int j = 0; j <= 10; ++j) {
        if (is_specimen(0.5 * i, 0.5 * j)) {
          grid << 0.5 * i << "," << 0.5 * j << ",0,0\n";
        }
      }
    }
    testing::WriteText(folder_ / "grid.csv", grid.str());
    WriteScene("grid.csv", R"(, "gaps": "open")", R"( } ],
      "cases": [ {"loads": [ {"type": "force", "value": [50, 0],
                              "surface": {"box": [[20, 0], [20, 5]]} )");
    Succeed("simulate scene.json --youngs=2000 --nu=0.35 --out=true.csv");
    std::istringstream truth(testing::ReadText(folder_ / "true.csv"));
    std::ostringstream seen;
    seen << std::setprecision(17) << "x,y,ux,uy\n";
    std::mt19937_64 generator(5);
    std::normal_distribution<double> noise(0, noise_sd);
    std::string line;
    std::getline(truth, line);
    char comma = ',';
    for (double x, y, u, v;
         truth >> x >> comma >> y >> comma >> u >> comma >> v;) {
      if (is_seen(x, y)) {
        seen << x << "," << y << "," << u + noise(generator) << ","
             << v + noise(generator) << "\n";
      }
    }
    testing::WriteText(folder_ / "points.csv", seen.str());
    WriteScene("points.csv", "", R"(, "displacement": "measured"},
      {"nodes": {"box": [[20, 0], [20, 5]]}, "displacement": "measured"} ],
      "cases": [ {"loads": [ {"type": "resultant", "value": [50, null],
                              "sd": 0.1,
                              "surface": {"box": [[20, 0], [20, 5]]} )");
  }

  // Expects the truth, and returns the notices.
  std::string NoticesOfRightEstimate(double largest_error = 0.05) const {
    const nlohmann::json report =
        Succeed("estimate scene.json --estimator=auto --json=-").Json();
    EXPECT_EQ(report["status"], "ok") << report["message"];
    const double error = report["standard_error"]["youngs_modulus"];
    EXPECT_NEAR(report["youngs_modulus"], kTrueModulus, 3 * error);
    EXPECT_LT(error, largest_error * kTrueModulus);
    return report["notices"].dump();
  }

  static bool IsAll(double, double) { return true; }
};

bool IsBeyondBite(double x, double y) { return y < 4 || x < 3 || x > 17; }

TEST_F(GapChoice, LetsTheSpecimenGoOnWherePointsWereLostAtAFreeEdge) {
  Measure(IsAll, IsBeyondBite);
  EXPECT_THAT(NoticesOfRightEstimate(),
              HasSubstr("specimen is assumed to go on there"));
}

TEST_F(GapChoice, EndsTheSpecimenAtANarrowPart) {
  Measure(IsBeyondBite, IsAll);
  EXPECT_THAT(NoticesOfRightEstimate(),
              HasSubstr("specimen is assumed to end there"));
}

TEST_F(GapChoice, TellsAHoleFromPointsThatWereLost) {
  Measure([](double x, double y) { return std::hypot(x - 14, y - 2.5) > 0.9; },
          [](double x, double y) { return std::hypot(x - 5, y - 2.5) > 0.9; });
  // Linear elements, which made the data, are stiff around the hole.
  const std::string notices = NoticesOfRightEstimate(0.3);
  EXPECT_THAT(notices,
              HasSubstr("around (5, 2.5); the specimen is assumed to go on"));
  EXPECT_THAT(notices,
              HasSubstr("around (14, 2.5); the specimen is assumed to end"));
}

// The last of three frames of the same specimen decides.
TEST_F(GapChoice, DecidesForFramesByTheLargestLoad) {
  Measure(IsAll, IsBeyondBite);
  std::string scene = testing::ReadText(folder_ / "scene.json");
  scene.replace(scene.rfind('}'), 1, R"(, "frames": {"files": "points.csv"}})");
  testing::WriteText(folder_ / "scene.json", scene);
  EXPECT_THAT(NoticesOfRightEstimate(),
              HasSubstr("specimen is assumed to go on there"));
}

// Noise hides what three points of a free edge would change.
TEST_F(GapChoice, SaysWhatItMayChangeWhereDisplacementsDoNotTell) {
  Measure(
      IsAll, [](double x, double y) { return y < 5 || x < 10 || x > 11; },
      0.02);
  EXPECT_THAT(NoticesOfRightEstimate(0.1),
              HasSubstr("although the displacements do not decide that"));
}

}  // namespace
}  // namespace elastimate
