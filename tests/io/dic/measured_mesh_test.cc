// Meshes of the points that a camera followed, in a scene.json.

#include "elastimate/io/dic/measured_mesh.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <cmath>
#include <iomanip>
#include <sstream>
#include <string>

#include "elastimate/estimators/registry.h"
#include "elastimate/io/scene/scene_reader.h"
#include "tests/io/scene_files.h"
#include "tests/throws.h"

namespace elastimate {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;

constexpr double kStress = 3;
constexpr double kModulus = 2000;
constexpr double kRatio = 0.25;

// A strip of 6 x 2, of thickness 0.5, that grips pull and a camera sees.
const std::string kStrip = R"({
  "model": "plane_stress", "thickness": 0.5,
  "mesh": {"points": "frame.csv", "margin": 0},
  "supports": [ {"nodes": {"box": [[0, 0], [0, 2]]}, "displacement": "measured"},
                {"nodes": {"box": [[6, 0], [6, 2]]}, "displacement": "measured"} ],
  "cases": [ {"loads": [ {"type": "resultant", "value": [3, null],
                          "surface": {"box": [[6, 0], [6, 2]]},
                          "relative_sd": 0.01} ]} ]
})";

class MeasuredMeshTest : public ::testing::Test {
 protected:
  MeasuredMeshTest() { folder_.Write("frame.csv", Frame()); }

  // Uniaxial stress, with a rigid motion of the strip.
  static std::string Frame() {
    std::ostringstream text;
    text << std::setprecision(17) << "x [mm],y [mm],ux [mm],uy [mm]\n";
    for (int i = 0; i <= 12; ++i) {
      for (int j = 0; j <= 4; ++j) {
        const double x = 0.5 * i;
        const double y = 0.5 * j;
        text << x << "," << y << "," << kStress / kModulus * x - 1e-4 * y + 0.2
             << "," << -kRatio * kStress / kModulus * y + 1e-4 * x << "\n";
      }
    }
    return text.str();
  }

  // The strain of Frame, seen by a camera that turned by an angle.
  static std::string TurnedFrame(double angle) {
    std::ostringstream text;
    text << std::setprecision(17) << "x,y,ux,uy\n";
    for (int i = 0; i <= 12; ++i) {
      for (int j = 0; j <= 4; ++j) {
        const Eigen::Vector2d x(0.5 * i, 0.5 * j);
        const Eigen::Vector2d strain(kStress / kModulus,
                                     -kRatio * kStress / kModulus);
        const Eigen::Vector2d u = Eigen::Rotation2Dd(angle).toRotationMatrix() *
                                      (x + strain.cwiseProduct(x)) -
                                  x;
        text << x(0) << "," << x(1) << "," << u(0) << "," << u(1) << "\n";
      }
    }
    return text.str();
  }

  SceneReading Read(const std::string& document) const {
    return ReadScene({folder_.Write("scene.json", document)},
                     Measurement::kRequired);
  }

  const TemporaryFolder folder_;
};

// A strip that is seen 1.5 wide of its width of 2.
TEST_F(MeasuredMeshTest, AllowsForTheMarginOfTheSpecimen) {
  std::istringstream frame(Frame());
  std::string within;
  for (std::string line; std::getline(frame, line);) {
    const bool is_rim = line.find(",0,") != std::string::npos &&
                        line.find(",0,") == line.find(',');
    within += is_rim ? "" : line + "\n";
  }
  folder_.Write("frame.csv", within);
  std::string document = kStrip;
  const std::string margin = "\"margin\": 0";
  document.replace(document.find(margin), margin.size(), "\"margin\": 0.25");
  const Estimate given =
      MakeEstimator("iterative-fe")->Run(Read(document).scene, {});
  ASSERT_TRUE(given.IsUsable()) << given.message;
  EXPECT_NEAR(given.elasticity.youngs_modulus, kModulus, 1e-3 * kModulus);
  EXPECT_FALSE(given.Has(FindingCode::kMarginNotGiven));

  folder_.Write("frame.csv", Frame());
  const std::string key = ", \"margin\": 0.25";
  document.erase(document.find(key), key.size());
  const Estimate open =
      MakeEstimator("iterative-fe")->Run(Read(document).scene, {});
  ASSERT_TRUE(open.IsUsable()) << open.message;
  EXPECT_TRUE(open.Has(FindingCode::kMarginNotGiven));
  // Half a spacing of 0.5 at 12 of free edges around 12.
  EXPECT_NEAR(*open.YoungsModulusStandardError() / kModulus,
              std::hypot(0.01, 0.25), 1e-3);
}

// A part of them would bear the force of all.
TEST_F(MeasuredMeshTest, IsNotOfAPartOfThePoints) {
  std::string apart = Frame();
  for (int i = 0; i < 20; ++i) {
    apart += std::to_string(0.5 * i) + ",30,0,0\n" + std::to_string(0.5 * i) +
             ",30.5,0,0\n";
  }
  folder_.Write("frame.csv", apart);
  EXPECT_THAT([&] { Read(kStrip); },
              ::testing::ThrowsMessage<std::invalid_argument>(
                  HasSubstr("40 of the 105 points")));
}

TEST_F(MeasuredMeshTest, WithGripsAndALoadCellGivesTheTruth) {
  const SceneReading reading = Read(kStrip);
  EXPECT_EQ(reading.scene.mesh.kind, ElementKind::kQuad4);
  EXPECT_EQ(reading.scene.mesh.NumElements(), 48);
  EXPECT_THAT(
      reading.notices,
      ElementsAre(HasSubstr(
          "points (format csv) has 48 quadrilaterals and 65 nodes, and is "
          "6 x 2")));
  for (const std::string estimator : {"iterative-fe", "auto"}) {
    const Estimate estimate = MakeEstimator(estimator)->Run(reading.scene, {});
    ASSERT_EQ(estimate.status, Status::kOk) << estimate.message;
    EXPECT_NEAR(estimate.elasticity.youngs_modulus, kModulus, 1e-8 * kModulus);
    EXPECT_NEAR(estimate.elasticity.poisson_ratio, kRatio, 1e-8);
    // The load cell scales E.
    EXPECT_NEAR(*estimate.YoungsModulusStandardError(), 0.01 * kModulus,
                1e-4 * kModulus);
  }
}

// Points that a camera lost are no holes.
TEST_F(MeasuredMeshTest, WithLostPointsGivesTheTruth) {
  std::string frame = Frame();
  for (const std::string point : {"\n2,1,", "\n0,0.5,", "\n4,1.5,"}) {
    const std::size_t begin = frame.find(point);
    ASSERT_NE(begin, std::string::npos) << point;
    frame.erase(begin, frame.find('\n', begin + 1) - begin);
  }
  folder_.Write("frame.csv", frame);
  const SceneReading reading = Read(kStrip);
  EXPECT_EQ(reading.scene.mesh.NumElements(), 48);
  EXPECT_EQ(reading.scene.load_cases[0].observed.count(), 2 * (65 - 3));
  EXPECT_THAT(reading.notices[0], HasSubstr("filled with 3 nodes"));
  const Estimate estimate =
      MakeEstimator("iterative-fe")->Run(reading.scene, {});
  ASSERT_EQ(estimate.status, Status::kOk) << estimate.message;
  EXPECT_NEAR(estimate.elasticity.youngs_modulus, kModulus, 1e-8 * kModulus);
  EXPECT_NEAR(estimate.elasticity.poisson_ratio, kRatio, 1e-8);
}

// Five points of a free edge are lost.
TEST_F(MeasuredMeshTest, HasTheGapsThatAreFilled) {
  std::string frame = Frame();
  for (const std::string point :
       {"\n2,2,", "\n2.5,2,", "\n3,2,", "\n3.5,2,", "\n4,2,"}) {
    const std::size_t begin = frame.find(point);
    ASSERT_NE(begin, std::string::npos) << point;
    frame.erase(begin, frame.find('\n', begin + 1) - begin);
  }
  folder_.Write("frame.csv", frame);
  const SceneReading open = Read(kStrip);
  EXPECT_EQ(open.scene.mesh.NumElements(), 48 - 6);
  ASSERT_EQ(open.gaps.size(), 1);
  EXPECT_EQ(open.gaps[0].num_places, 5);
  EXPECT_EQ(open.gaps[0].center, Eigen::Vector2d(3, 2));
  const SceneReading filled =
      ReadScene({folder_.Write("scene.json", kStrip)}, Measurement::kRequired,
                {{}, {}, {}, {}, {true}});
  EXPECT_EQ(filled.scene.mesh.NumElements(), 48);
  EXPECT_EQ(filled.scene.load_cases[0].observed.count(), 2 * (65 - 5));
  for (const auto& [word, num_elements] :
       {std::pair("filled", 48), std::pair("open", 42)}) {
    std::string document = kStrip;
    const std::string margin = "\"margin\": 0";
    document.replace(document.find(margin), margin.size(),
                     margin + ", \"gaps\": \"" + word + "\"");
    const SceneReading given = Read(document);
    EXPECT_EQ(given.scene.mesh.NumElements(), num_elements);
    EXPECT_TRUE(given.gaps.empty());
  }
}

// Rows of points above and below a slanted edge lie up to a spacing inside.
TEST_F(MeasuredMeshTest, CountsHalfASpacingAtSlantedEdges) {
  std::istringstream frame(Frame());
  std::string below;
  for (std::string line; std::getline(frame, line);) {
    const double x = std::atof(line.c_str());
    const double y = std::atof(line.c_str() + line.find(',') + 1);
    below += line[0] == 'x' || y <= 0.5 + x / 4 ? line + "\n" : "";
  }
  folder_.Write("frame.csv", below);
  const Section section = Read(kStrip).scene.mesh.section;
  // Steps of two edges and one, twelve and three in all but the held ones, and
  // 33 of the 48 elements.
  EXPECT_GT(section.thickness, 0.5);
  EXPECT_NEAR(section.thickness / 0.5 - 1, section.thickness_relative_sd,
              1e-12);
}

TEST_F(MeasuredMeshTest, WithTractionAndAFreeCameraGivesTheTruth) {
  const std::string document = R"({
    "model": "plane_stress", "thickness": 0.5,
    "mesh": {"points": "frame.csv", "margin": 0},
    "rigid_motion": "free",
    "supports": [ {"nodes": {"box": [[0, 0], [0, 2]]}, "components": "x"},
                  {"nodes": {"box": [[0, 0], [0, 0]]}, "components": "y"} ],
    "cases": [ {"loads": [ {"type": "force", "value": [3, 0],
                            "surface": {"box": [[6, 0], [6, 2]]}} ]} ]
  })";
  for (const double angle : {1e-4, 5e-3, 0.3, 3.0}) {
    folder_.Write("frame.csv", TurnedFrame(angle));
    const Estimate estimate =
        MakeEstimator("iterative-fe")->Run(Read(document).scene, {});
    ASSERT_EQ(estimate.status, Status::kOk) << estimate.message;
    EXPECT_NEAR(estimate.elasticity.youngs_modulus, kModulus, 1e-8 * kModulus);
    EXPECT_NEAR(estimate.elasticity.poisson_ratio, kRatio, 1e-8);
  }
}

TEST_F(MeasuredMeshTest, OtherEstimatorsSayWhichOneToUse) {
  const Scene scene = Read(kStrip).scene;
  for (const std::string estimator :
       {"closed-form", "bounded", "virtual-fields", "reduced-fe"}) {
    EXPECT_THROWS_WITH(MakeEstimator(estimator)->Run(scene, {}),
                       "use --estimator=iterative-fe");
  }
}

TEST_F(MeasuredMeshTest, OfMicrometresGivesTheTruth) {
  std::string frame = Frame();
  frame.replace(0, frame.find('\n'), "X [um],Y [um],U [nm],V [nm]");
  folder_.Write("frame.csv", frame);
  const SceneReading reading = Read(kStrip);
  EXPECT_THAT(reading.notices,
              ElementsAre(HasSubstr("points"), HasSubstr("converted to um")));
  const Estimate estimate =
      MakeEstimator("iterative-fe")->Run(reading.scene, {});
  ASSERT_EQ(estimate.status, Status::kOk) << estimate.message;
  EXPECT_NEAR(estimate.elasticity.youngs_modulus, 1e3 * kModulus,
              1e-5 * kModulus);
}

TEST_F(MeasuredMeshTest, TellsWhatIsWrong) {
  const auto expect = [&](const std::string& from, const std::string& to,
                          const std::string& message) {
    EXPECT_THROWS_WITH(Read(Replaced(kStrip, from, to)), message);
  };
  expect("frame.csv", "none.csv", "none.csv");
  expect(R"("points": "frame.csv")", R"("points": "")", "is empty");
  expect(R"("points": "frame.csv")", R"("points": "frame.csv", "format": "x")",
         "the formats known here are auto, matchid");
  expect(R"("points": "frame.csv")",
         R"("points": "frame.csv", "length_per_pixel": 0)", "must be positive");
  expect(R"("points": "frame.csv")", R"("points": "frame.csv", "flip_y": 1)",
         "must be true or false");
  expect(R"("points": "frame.csv")", R"("points": "frame.csv", "size": 1)",
         "size");
  expect(R"("displacement": "measured"})", R"("displacement": "free"})",
         R"(make it "measured", "rigid" or a vector)");
  expect(R"([[6, 0], [6, 2]]}, "displacement": "measured")",
         R"([[0, 0], [6, 2]]}, "displacement": "rigid")",
         "differently from supports\\[0\\]");
  expect(R"("relative_sd": 0.01)", R"("nothing": 0.01)", "nothing");
  expect(R"(,
                          "relative_sd": 0.01)",
         "", "exactly one of the keys \"sd\" and \"relative_sd\"");
  expect(R"("relative_sd": 0.01)", R"("relative_sd": 0)", "must be positive");
  expect("[3, null]", "[null, null]", "has no number");
  expect("[3, null]", "[0, null]", "relative to a force of zero");
  expect("[3, null]", "[3]", "must be a list of 2 numbers");
  expect(R"([[6, 0], [6, 2]]},
                          "rel)",
         R"([[3, 0], [3, 2]]},
                          "rel)",
         "of a surface that no support holds there");
  expect(R"("cases")", R"("rigid_motion": "fixed", "cases")",
         R"(make it "free")");
}

}  // namespace
}  // namespace elastimate
