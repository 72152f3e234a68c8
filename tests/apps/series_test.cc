// Tests of the command line with scenes of several frames.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <iomanip>
#include <nlohmann/json.hpp>
#include <random>
#include <regex>
#include <sstream>
#include <string>
#include <vector>

#include "elastimate/core/mesh/mesh_points.h"
#include "elastimate/io/points/point_locator.h"
#include "elastimate/io/scene/scene_reader.h"
#include "tests/program.h"

namespace elastimate {
namespace {

using ::testing::HasSubstr;
using ::testing::Not;

constexpr double kYoungs = 2000;
constexpr double kPoisson = 0.3;
constexpr double kNoise = 1e-4;

// A camera takes frames of a strip of 6 x 2 that grips pull.  A load record
// gives the force of each frame; the first frame is under no load.
class Series : public testing::ProgramTest {
 protected:
  void SetUp() override {
    testing::ProgramTest::SetUp();
    WriteFrames(0);
    WriteScene(R"("load_record": {"file": "load.csv", "column": "Force [N]"})");
  }

  // E falls by the share `softening` up to the largest load.  The reference
  // image has noise of the standard deviation `shared`, and the camera turned
  // by `angle` after it.
  void WriteFrames(double softening, double shared = 0,
                   double angle = 0) const {
    std::ostringstream record;
    record << "Force [N]\n";
    std::mt19937_64 generator(3);
    std::normal_distribution<double> noise(0, kNoise);
    for (int number = 0; number <= 6; ++number) {
      const double stress = number;
      const double strain = stress / (kYoungs * (1 - softening * number / 6));
      std::ostringstream text;
      text << std::setprecision(17) << "x,y,ux,uy\n";
      std::mt19937_64 reference(9);
      std::normal_distribution<double> common(0, 1);
      for (int i = 0; i <= 12; ++i) {
        for (int j = 0; j <= 4; ++j) {
          const double x = 0.5 * i;
          const double y = 0.5 * j;
          const double of_x = noise(generator) + shared * common(reference);
          const double of_y = noise(generator) + shared * common(reference);
          const double to_x = (1 + strain) * x;
          const double to_y = (1 - kPoisson * strain) * y;
          text << x << "," << y << ","
               << std::cos(angle) * to_x - std::sin(angle) * to_y - x + of_x
               << ","
               << std::sin(angle) * to_x + std::cos(angle) * to_y - y + of_y
               << "\n";
        }
      }
      testing::WriteText(
          folder_ / ("frame_" + std::to_string(number + 5) + ".csv"),
          text.str());
      record << stress * 2 * 0.5 << "\n";
    }
    testing::WriteText(folder_ / "load.csv", record.str());
  }

  // Writes `count` frames under the same load, whose force is known to 2 %.
  // The error of the force is the same in all frames, and far above their
  // noise.
  void WriteFramesOfOneLoad(int count) const {
    std::mt19937_64 generator(4);
    std::normal_distribution<double> noise(0, 0.1 * kNoise);
    for (int number = 0; number < count; ++number) {
      std::ostringstream text;
      text << std::setprecision(17) << "x,y,ux,uy\n";
      for (int i = 0; i <= 12; ++i) {
        for (int j = 0; j <= 4; ++j) {
          const double of_x = noise(generator);
          text << 0.5 * i << "," << 0.5 * j << ","
               << 5 / kYoungs * 0.5 * i + of_x << ","
               << -5 / kYoungs * kPoisson * 0.5 * j + noise(generator) << "\n";
        }
      }
      testing::WriteText(folder_ / ("frame_" + std::to_string(number) + ".csv"),
                         text.str());
    }
    const std::string scene = testing::ReadText(folder_ / "scene.json");
    testing::WriteText(
        folder_ / "scene.json",
        std::regex_replace(
            std::regex_replace(
                std::regex_replace(scene, std::regex("\"sd\": 1e-4"),
                                   "\"relative_sd\": 0.02"),
                std::regex("\\[1, null\\]"), "[5, null]"),
            std::regex(", \"load_record\": \\{[^}]*\\}"), ""));
  }

  void WriteScene(const std::string& frames) const {
    testing::WriteText(folder_ / "scene.json", R"({
      "model": "plane_stress", "thickness": 0.5,
      "mesh": {"points": "frame_5.csv", "margin": 0},
      "supports": [
        {"nodes": {"box": [[0, 0], [0, 2]]}, "displacement": "measured"},
        {"nodes": {"box": [[6, 0], [6, 2]]}, "displacement": "measured"} ],
      "cases": [ {"loads": [ {"type": "resultant", "value": [1, null],
                              "surface": {"box": [[6, 0], [6, 2]]},
                              "sd": 1e-4} ]} ],
      "frames": {"files": "frame_*.csv", )" + frames +
                                                   "}\n}\n");
  }

  std::vector<std::string> Rows() const {
    std::istringstream text(testing::ReadText(folder_ / "series.csv"));
    std::vector<std::string> rows;
    for (std::string row; std::getline(text, row);) {
      rows.push_back(row);
    }
    return rows;
  }
};

TEST_F(Series, IsATableOfFramesAndTheirJointEstimate) {
  const nlohmann::json report =
      Succeed(
          "estimate scene.json --estimator=auto --series=series.csv "
          "--json=-")
          .Json();
  EXPECT_EQ(report["status"], "ok");
  EXPECT_EQ(report["series"]["frames"], 7);
  EXPECT_EQ(report["series"]["used"], 6);
  EXPECT_EQ(report["series"]["loads"], nlohmann::json({1.0, 6.0}));
  EXPECT_EQ(report["series"]["changes_over"], "load");
  EXPECT_GT(report["series"]["changes"][0]["p_value"], 0.01);
  const double error = report["standard_error"]["youngs_modulus"];
  EXPECT_NEAR(report["youngs_modulus"], kYoungs, 3 * error);
  // The error is about the noise over the strain of the frames, each of which
  // has 130 components.
  EXPECT_LT(error / kYoungs, 0.02);
  const std::vector<std::string> rows = Rows();
  ASSERT_EQ(rows.size(), 9);
  EXPECT_EQ(rows[0],
            "frame,file,load,status,youngs_modulus,"
            "youngs_modulus_standard_error,poisson_ratio,"
            "poisson_ratio_standard_error,noise_sd,outliers,findings,reason");
  EXPECT_EQ(rows[1],
            "1,frame_5.csv,0.0,not_run,,,,,,0,not_run,\"the load of this frame "
            "is zero, so that it gives no estimate\"");
  EXPECT_THAT(rows[7], HasSubstr("7,frame_11.csv,6.0,ok,"));
  EXPECT_THAT(rows[8], HasSubstr("joint,,,ok,"));
}

TEST_F(Series, IsTheSameWithAnyNumberOfThreads) {
  testing::WriteText(folder_ / "frame_7.csv", "x,y,ux,uy\n1,2,abc,4\n");
  const auto estimate = [&](const std::string& threads) {
    return Succeed(
               "estimate scene.json --estimator=auto --series=series.csv "
               "--json=- --threads=" +
               threads)
        .Json();
  };
  nlohmann::json one = estimate("1");
  const std::vector<std::string> rows_of_one = Rows();
  // More threads than frames.
  nlohmann::json several = estimate("9");
  EXPECT_EQ(Rows(), rows_of_one);
  one.erase("seconds");
  several.erase("seconds");
  EXPECT_EQ(one, several);
}

TEST_F(Series, TellsThatTheModulusDependsOnTheLoad) {
  WriteFrames(0.2);
  const std::string output =
      Succeed("estimate scene.json --estimator=iterative-fe").output;
  EXPECT_THAT(output, HasSubstr("6 of 7 used, at 1 to 6 times the loads"));
  EXPECT_THAT(output, HasSubstr("from the least load to the largest"));
}

TEST_F(Series, TellsWhatFramesShare) {
  const std::string estimate = "estimate scene.json --estimator=auto --json=-";
  const nlohmann::json alone = Succeed(estimate).Json();
  WriteFrames(0, 2 * kNoise);
  const nlohmann::json shared = Succeed(estimate).Json();
  const auto has_finding = [](const nlohmann::json& report) {
    for (const nlohmann::json& finding : report["findings"]) {
      if (finding["code"] == "frames_alike") {
        return true;
      }
    }
    return false;
  };
  EXPECT_FALSE(has_finding(alone));
  EXPECT_TRUE(has_finding(shared));
  // The reference image has twice the noise of a frame.  So a frame has 5^(1/2)
  // times the noise, and 4/5 of its variance is common to all 6 frames: the
  // mean is little better than one frame.
  const auto error = [](const nlohmann::json& report) {
    return double(report["standard_error"]["poisson_ratio"]);
  };
  EXPECT_GT(error(shared) / error(alone), 3);
}

TEST_F(Series, DoesNotTakeARotationForWhatFramesShare) {
  WriteFrames(0, 0, 0.05);
  const std::string scene = testing::ReadText(folder_ / "scene.json");
  testing::WriteText(
      folder_ / "scene.json",
      std::regex_replace(scene, std::regex("\"model\""),
                         "\"rigid_motion\": \"free\", \"model\""));
  const nlohmann::json report =
      Succeed("estimate scene.json --estimator=iterative-fe --json=-").Json();
  EXPECT_EQ(report["series"]["used"], 6);
  EXPECT_EQ(report["status"], "ok");
  EXPECT_THAT(report["findings"].dump(), Not(HasSubstr("frames_alike")));
  EXPECT_NEAR(report["youngs_modulus"], kYoungs,
              3 * double(report["standard_error"]["youngs_modulus"]));
}

TEST_F(Series, AveragesTheNoiseOfWhatLoadsSayNothingOf) {
  WriteFramesOfOneLoad(60);
  const nlohmann::json report =
      Succeed("estimate scene.json --estimator=iterative-fe --json=-").Json();
  EXPECT_EQ(report["series"]["used"], 60);
  for (const nlohmann::json& finding : report["findings"]) {
    EXPECT_NE(finding["code"], "frames_scatter") << finding["text"];
  }
  // The error of the load is an error of E alone: it leaves nu as it is.
  EXPECT_NEAR(double(report["standard_error"]["youngs_modulus"]) / kYoungs,
              0.02, 0.002);
  const double error = report["standard_error"]["poisson_ratio"];
  EXPECT_NEAR(report["poisson_ratio"], kPoisson, 4 * error);
  // One frame determines nu to 0.0008.
  EXPECT_LT(error, 3 * 0.0008 / std::sqrt(60));
}

TEST_F(Series, HasARowForAFrameThatCannotBeRead) {
  testing::WriteText(folder_ / "frame_7.csv", "x,y,ux,uy\n1,2,abc,4\n");
  Succeed("estimate scene.json --estimator=auto --series=series.csv");
  EXPECT_THAT(Rows()[3], HasSubstr("not_run"));
  EXPECT_THAT(Rows()[3], HasSubstr("frame_7.csv: line 2"));
  EXPECT_THAT(Rows()[4], HasSubstr(",ok,"));
}

TEST_F(Series, IsNotUsableWithoutAUsableFrame) {
  testing::WriteText(folder_ / "load.csv", "Force [N]\n0\n0\n0\n0\n0\n0\n0\n");
  const testing::ProgramRun run =
      Run("estimate scene.json --estimator=auto --series=series.csv");
  EXPECT_EQ(run.exit_code, 1);
  EXPECT_THAT(run.output, HasSubstr("none of the 7 frames"));
  EXPECT_EQ(Rows().size(), 9);
}

TEST_F(Series, IsRefusedWhereItDoesNotBelong) {
  Refuse("estimate scene.json --estimator=auto --out=a.vtu",
         "--out=a.vtu cannot be used");
  Refuse("estimate scene.json --estimator=auto --order=2", "--order=2");
  Refuse("estimate scene.json --estimator=reduced-fe",
         "frame_6.csv: reduced-fe: ");
  Refuse("estimate scene.json --estimator=auto --series=frame_7.csv",
         "would overwrite a frame");
  Refuse("estimate scene.json --estimator=auto --series=a --json=a",
         "name the same file");
  Refuse("estimate scene.json scene.json --estimator=auto", "given twice");
  Succeed("generate cuboid --out=cuboid.vtu");
  Succeed("simulate cuboid.vtu --youngs=1 --nu=0.3 --out=exact.vtu");
  Refuse("estimate exact.vtu --series=a.csv",
         "--series=a.csv needs a scene of several frames");
}

// An indenter presses into the middle of a block of gel on a table in 20 steps,
// while cameras follow 500 points of its sides and top.
class Gel : public testing::ProgramTest {
 protected:
  static constexpr int kSteps = 20;
  static constexpr double kGelNoise = 0.005;

  void MakeFrames() const {
    Succeed("generate cuboid --cells=12,12,6 --size=60,60,30 --out=gel.vtu");
    WriteScene("");
    Succeed("simulate scene.json --youngs=0.012 --nu=0.45 --out=exact.vtu");
    const Scene scene =
        ReadScene({folder_ / "exact.vtu"}, Measurement::kRequired).scene;
    const Eigen::MatrixXd points = SurfacePoints();
    const LocatedPoints located = PointLocator(scene.mesh).Locate(points);
    const Eigen::MatrixXd u = Interpolate(scene.mesh, located.points,
                                          scene.load_cases[0].displacement);
    std::mt19937_64 generator(5);
    std::normal_distribution<double> noise(0, kGelNoise);
    std::ostringstream record;
    record << "step,force\n";
    for (int step = 1; step <= kSteps; ++step) {
      std::ostringstream text;
      text << std::setprecision(17) << "x,y,z,ux,uy,uz\n";
      for (Eigen::Index i = 0; i < points.cols(); ++i) {
        text << points(0, i) << "," << points(1, i) << "," << points(2, i);
        for (int axis = 0; axis < 3; ++axis) {
          text << "," << 0.05 * step * u(axis, i) + noise(generator);
        }
        text << "\n";
      }
      testing::WriteText(folder_ / ("step_" + std::to_string(step) + ".csv"),
                         text.str());
      record << step << "," << 0.05 * step << "\n";
    }
    testing::WriteText(folder_ / "record.csv", record.str());
  }

  static Eigen::MatrixXd SurfacePoints() {
    std::mt19937_64 generator(4);
    std::uniform_real_distribution<double> place(0, 60);
    Eigen::MatrixXd points(3, 500);
    for (int i = 0; i < 500; ++i) {
      points.col(i) << place(generator), place(generator), 30;
      if (i % 2 == 0) {
        points(i % 4 / 2, i) = 60;
        points(2, i) = place(generator) / 2;
      }
    }
    return points;
  }

  void WriteScene(const std::string& frames) const {
    testing::WriteText(folder_ / "scene.json", R"({
  "mesh": "gel.vtu", "origin": "computed",
  "supports": [ {"nodes": {"box": [[-1, -1, -1], [61, 61, 0.001]]}} ],
  "cases": [
    { "loads": [ {"type": "force", "value": [0, 0, -1],
                  "surface": {"box": [[19, 19, 29.9], [41, 41, 31]]}} ] } ])" +
                                                   frames + "\n}\n");
  }
};

TEST_F(Gel, UnderAnIndenterNeedsNoProgramming) {
  MakeFrames();
  WriteScene(R"(,
  "frames": {"files": "step_*.csv",
             "load_record": {"file": "record.csv", "column": "force"}})");
  const nlohmann::json report =
      Succeed(
          "estimate scene.json --estimator=reduced-fe --series=series.csv "
          "--json=-")
          .Json();
  EXPECT_EQ(report["status"], "ok");
  EXPECT_EQ(report["series"]["used"], kSteps);
  const double error = report["standard_error"]["youngs_modulus"];
  EXPECT_NEAR(report["youngs_modulus"], 0.012, 3 * error);
  EXPECT_LT(error / 0.012, 0.05);
  EXPECT_NEAR(report["poisson_ratio"], 0.45,
              3 * double(report["standard_error"]["poisson_ratio"]));
}

}  // namespace
}  // namespace elastimate
