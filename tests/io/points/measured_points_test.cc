#include "elastimate/io/points/measured_points.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <iomanip>
#include <sstream>

#include "elastimate/estimators/registry.h"
#include "elastimate/io/scene/scene_reader.h"
#include "elastimate/io/vtk/vtu_writer.h"
#include "tests/io/scene_files.h"
#include "tests/random_points.h"
#include "tests/scenes.h"
#include "tests/throws.h"

namespace elastimate {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;

constexpr double kModulusOfPoints = 2e4;
constexpr double kRatioOfPoints = 0.35;

const std::string kPointsDocument = R"({
  "mesh": "cube.vtu",
  "supports": [ {"nodes": {"box": [[-1, -1, -1], [2, 2, 0]]}} ],
  "cases": [
    { "displacement": {"points": "points.csv"},
      "loads": [ {"type": "force", "value": [3, 1, -20],
                  "surface": {"box": [[-1, -1, 1], [2, 2, 2]]}} ] } ]
})";

// The scene is a cube, of which 100 points were moved as an E and a nu say.
class MeasuredPointsTest : public ::testing::Test {
 protected:
  MeasuredPointsTest() {
    scene_.mesh = testing::BoxMesh({4, 4, 4}, {1, 1, 1});
    WriteVtu(folder_.Path() / "cube.vtu", scene_.mesh, {});
    folder_.Write("points.csv", "x,y,z,ux,uy,uz\n0.5,0.5,0.5,0,0,0\n");
    scene_ = Read(kPointsDocument).scene;
    scene_.load_cases[0].points = {};
    testing::Measure({kModulusOfPoints, kRatioOfPoints}, scene_);
    testing::MeasureAtPoints(100, 1, scene_);
    folder_.Write("points.csv", Table(0, 100));
  }

  // Returns the table of the points in [begin, end).
  std::string Table(Eigen::Index begin, Eigen::Index end) const {
    const PointDisplacements& points = scene_.load_cases[0].points;
    const Eigen::MatrixXd x =
        Interpolate(scene_.mesh, points.points, scene_.mesh.nodes);
    std::ostringstream text;
    text << std::setprecision(17) << "x,y,z,ux,uy,uz\n";
    for (Eigen::Index i = begin; i < end; ++i) {
      for (const double value : x.col(i)) {
        text << value << ",";
      }
      const auto u = points.displacement.col(i);
      text << u(0) << "," << u(1) << "," << u(2) << "\n";
    }
    return text.str();
  }

  SceneReading Read(const std::string& document) const {
    return ReadScene({folder_.Write("scene.json", document)},
                     Measurement::kRequired);
  }

  const TemporaryFolder folder_;
  Scene scene_;
};

TEST_F(MeasuredPointsTest, GiveTheTruth) {
  const SceneReading reading = Read(kPointsDocument);
  EXPECT_THAT(reading.notices, ElementsAre());
  EXPECT_EQ(reading.scene.load_cases[0].displacement.size(), 0);
  Scene scene = reading.scene;
  scene.origin = Origin::kComputed;
  const Estimate estimate = MakeEstimator("auto")->Run(scene, {});
  EXPECT_EQ(estimate.status, Status::kOk) << estimate.message;
  EXPECT_NEAR(estimate.elasticity.youngs_modulus / kModulusOfPoints, 1, 1e-6);
  EXPECT_NEAR(estimate.elasticity.poisson_ratio, kRatioOfPoints, 1e-6);
}

TEST_F(MeasuredPointsTest, MayComeFromSeveralFiles) {
  folder_.Write("a.csv", Table(0, 30));
  folder_.Write("b.csv", Table(30, 100));
  const Scene scene = Read(Replaced(kPointsDocument, R"("points.csv")",
                                    R"(["a.csv", "b.csv"])"))
                          .scene;
  const PointDisplacements& points = scene.load_cases[0].points;
  EXPECT_EQ(points.displacement,
            Read(kPointsDocument).scene.load_cases[0].points.displacement);
  EXPECT_EQ(points.points.Size(), 100);
}

TEST_F(MeasuredPointsTest, AreRefusedOutside) {
  folder_.Write("points.csv",
                "x,y,z,ux,uy,uz\n.5,.5,.5,0,0,1\n.5,.5,1.02,0,0,1\n"
                ".5,.5,1.031234,0,0,1\n");
  EXPECT_THROWS_WITH(
      Read(kPointsDocument),
      "points.csv: line 3: the point \\(0.5, 0.5, 1.02\\) lies 0.02 outside "
      "the mesh, more than the tolerance of 0.00173; .* or give the "
      ".tolerance. 0.0313, which takes all points of the file");
  const SceneReading reading =
      Read(Replaced(kPointsDocument, R"("points.csv")",
                    R"("points.csv", "tolerance": 0.0313)"));
  ASSERT_EQ(reading.notices.size(), 1U);
  EXPECT_THAT(reading.notices[0],
              HasSubstr("2 of 3 points lie outside the mesh, up to 0.0312"));
  // A tolerance does not mend points that were measured somewhere else.
  folder_.Write("points.csv", "x,y,z,ux,uy,uz\n.5,.5,-.5,0,0,1\n");
  EXPECT_THROWS_WITH(Read(kPointsDocument),
                     "line 2: .* check that the points have the origin, the "
                     "axes");
}

// A mesh file does not say which unit it has.
TEST_F(MeasuredPointsTest, AreInTheUnitOfTheScene) {
  const Eigen::MatrixXd displacement = scene_.load_cases[0].points.displacement;
  std::string table = Table(0, 100);
  table.replace(0, table.find('\n'),
                "X [cm],Y [cm],Z [cm],U [mm],V [mm],W [mm]");
  folder_.Write("points.csv", table);
  EXPECT_LT((Read(kPointsDocument).scene.load_cases[0].points.displacement -
             0.1 * displacement)
                .norm(),
            1e-14 * displacement.norm());
  // In a cube with edges of 101, points in cm would all lie in a corner.
  WriteVtu(folder_.Path() / "cube.vtu",
           testing::BoxMesh({4, 4, 4}, {101, 101, 101}), {});
  const auto with_keys = [](const std::string& keys) {
    return R"({"mesh": "cube.vtu", "supports": [ {"nodes": {"ids": [0, 1, 5]}} ],
      "cases": [ {"displacement": {"points": "points.csv")" +
           keys +
           R"(}, "loads": [{"type": "body_force", "value": [0, 0, 1]}]} ]})";
  };
  EXPECT_THROWS_WITH(Read(with_keys("")),
                     "points.csv: its points span .* cm, but the mesh spans "
                     "175; .* \"unit\"");
  const Scene scene = Read(with_keys(R"(, "unit": "mm")")).scene;
  EXPECT_LT((scene.load_cases[0].points.displacement - displacement).norm(),
            1e-14 * displacement.norm());
  EXPECT_THROWS_WITH(Read(with_keys(R"(, "unit": "px")")),
                     "displacement.unit is \"px\"; make");
}

TEST_F(MeasuredPointsTest, AreInOneUnitInAllFiles) {
  const std::string titles = "x [mm],y [mm],z [mm],ux [mm],uy [mm],uz [mm]\n";
  folder_.Write("a.csv", titles + ".5,.5,.5,0,0,1\n");
  folder_.Write("b.csv",
                Replaced(titles, "x [mm],y [mm],z [mm]", "x [m],y [m],z [m]") +
                    ".5,.5,.5,0,0,1\n");
  EXPECT_THROWS_WITH(
      Read(Replaced(kPointsDocument, R"("points.csv")",
                    R"(["a.csv", "b.csv"])")),
      "b.csv: the positions are in m, but those of another file of "
      "the scene are in mm");
}

TEST_F(MeasuredPointsTest, NameWhatIsWrong) {
  const auto with = [](const std::string& displacement) {
    return Replaced(kPointsDocument, R"({"points": "points.csv"})",
                    displacement);
  };
  EXPECT_THROWS_WITH(Read(with(R"({"points": "no.csv"})")), "no.csv");
  EXPECT_THROWS_WITH(
      Read(with(R"({"points": []})")),
      "displacement.points must be the name of a file of points");
  EXPECT_THROWS_WITH(
      Read(with(R"({"points": 5})")),
      "displacement.points must be the name of a file of points");
  EXPECT_THROWS_WITH(Read(with(R"({"points": "points.csv", "tol": 1})")),
                     "tol");
  EXPECT_THROWS_WITH(Read(with(R"({"points": "points.csv", "tolerance": -1})")),
                     "tolerance must not be negative");
  EXPECT_THROWS_WITH(Read(Replaced(kPointsDocument, R"("loads")",
                                   R"("observed": "all", "loads")")),
                     "leave out \"observed\"");
  folder_.Write("sd.csv",
                "x,y,z,ux,uy,uz,sd_ux,sd_uy,sd_uz\n.5,.5,.5,0,0,1,1,1,1\n");
  EXPECT_THROWS_WITH(Read(with(R"({"points": ["points.csv", "sd.csv"]})")),
                     "sd.csv: only some files of the load case have");
}

TEST_F(MeasuredPointsTest, AreNoFurtherLoadCaseTwice) {
  const auto path = folder_.Write("scene.json", kPointsDocument);
  const auto again = folder_.Write("again.json", kPointsDocument);
  EXPECT_THROWS_WITH(ReadScene({path, again}, Measurement::kRequired),
                     "give each load case only once");
}

}  // namespace
}  // namespace elastimate
