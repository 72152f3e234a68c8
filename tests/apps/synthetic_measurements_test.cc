// Plates with a hole are generated, measured by a simulated camera, and
// estimated, without any file of measurements.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <cmath>
#include <cstdlib>
#include <set>
#include <string>
#include <variant>

#include "elastimate/core/scene/scene.h"
#include "elastimate/io/points/points_file.h"
#include "elastimate/io/scene/scene_reader.h"
#include "tests/program.h"

namespace elastimate {
namespace {

class SyntheticMeasurements : public testing::ProgramTest {
 protected:
  /// Makes plate.vtu with these flags, and simulates it with the parameters of
  /// steel.
  testing::ProgramRun MakePlate(const std::string& flags = "--ends=grips") {
    Succeed("generate plate --cells=20 --out=plate.vtu " + flags);
    return Simulate("--out=exact.csv");
  }

  testing::ProgramRun Simulate(const std::string& flags) const {
    return Succeed("simulate plate.vtu --youngs=210000 --nu=0.3 " + flags);
  }

  PointsFile Points(const std::string& file, int dimension = 2) const {
    return ReadPointsFile(folder_ / file, dimension);
  }

  Scene SceneOf(const std::string& file) const {
    return ReadScene({folder_ / file}, Measurement::kOptional).scene;
  }

  /// Writes scene.json: the plate in grips of which `points` were measured, and
  /// this force along x.
  void WriteScene(const std::string& points, const std::string& force,
                  const std::string& origin = "computed") const {
    testing::WriteText(folder_ / "scene.json", R"({"origin": ")" + origin +
                                                   R"(",
      "mesh": "plate.vtu", "rigid_motion": "free",
      "supports": [
        {"nodes": {"box": [[0, 0], [0, 10]]}, "components": "x"},
        {"nodes": {"box": [[0, 0], [9.9, 0]]}, "components": "y"},
        {"nodes": {"box": [[10, 0], [10, 10]]}, "displacement": "rigid"}],
      "cases": [{"displacement": {"points": ")" + points +
                                                   R"("}, "loads": [
        {"type": "resultant", "value": [)" + force +
                                                   R"(, null],
         "relative_sd": 1e-6, "surface": {"box": [[10, 0], [10, 10]]}}]}]})");
  }

  nlohmann::json Estimate(const std::string& flags = "") const {
    return Succeed("estimate scene.json --estimator=iterative-fe --json=- " +
                   flags)
        .Json();
  }

  static void ExpectExact(const nlohmann::json& report,
                          double tolerance = 1e-6) {
    EXPECT_NEAR(report["youngs_modulus"].get<double>() / 210000, 1, tolerance);
    EXPECT_NEAR(report["poisson_ratio"].get<double>(), 0.3, tolerance);
  }

  static void ExpectWithinThreeErrors(const nlohmann::json& report) {
    const nlohmann::json& error = report["standard_error"];
    EXPECT_NEAR(report["youngs_modulus"].get<double>(), 210000,
                3 * error["youngs_modulus"].get<double>());
    EXPECT_NEAR(report["poisson_ratio"].get<double>(), 0.3,
                3 * error["poisson_ratio"].get<double>());
    EXPECT_LT(error["youngs_modulus"], 0.02 * 210000);
  }
};

/// Returns the force along x of the first load case, as simulate prints it.
std::string PrintedForce(const testing::ProgramRun& run) {
  const std::string begin = "load case 1: force of the displaced supports (";
  EXPECT_EQ(run.output.substr(0, begin.size()), begin);
  const std::string rest = run.output.substr(begin.size());
  return rest.substr(0, rest.find(','));
}

TEST_F(SyntheticMeasurements, OfAPlateInGripsGiveWhatWasSimulated) {
  const std::string force = PrintedForce(MakePlate());
  WriteScene("exact.csv", force);
  ExpectExact(Estimate());
}

// The specimen has quadratic elements, and the camera moves.
TEST_F(SyntheticMeasurements, OfAMovingCameraGiveWhatWasSimulated) {
  Succeed(
      "generate plate --cells=16 --elements=tri3 --ends=grips "
      "--out=plate.vtu");
  const std::string force =
      PrintedForce(Simulate("--order=2 --points=500 --out=still.csv"));
  for (const std::string angle : {"0.00005", "0.003", "0.5"}) {
    Simulate("--order=2 --points=500 --noise_sd=5e-5 --rigid_motion=0.1,-0.2," +
             angle + " --out=moved.csv");
    WriteScene("moved.csv", force, "measured");
    const nlohmann::json report = Estimate();
    ExpectWithinThreeErrors(report);
    EXPECT_NEAR(report["noise_sd"].get<double>() / 5e-5, 1,
                4 / std::sqrt(2 * 1000.0));
  }
}

TEST_F(SyntheticMeasurements, WithOutliersAndSmoothNoiseAreStillEstimated) {
  const std::string force = PrintedForce(MakePlate());
  Simulate(
      "--points=1000 --noise_sd=5e-5 --outliers=0.03 --out=camera.csv "
      "--seed=4");
  WriteScene("camera.csv", force);
  const nlohmann::json with_outliers = Estimate();
  ExpectWithinThreeErrors(with_outliers);
  // The report lists all outliers, but the notice only the first ten lines.
  EXPECT_THAT(
      with_outliers["notices"].back().get<std::string>(),
      ::testing::ContainsRegex("camera.csv: 3[01] outliers are on the lines "
                               "([0-9]+, ){10}\\.\\.\\.$"));
  Simulate("--points=1000 --noise_sd=5e-5 --out=plain.csv --seed=4");
  const Eigen::MatrixXd gross =
      Points("camera.csv").displacement - Points("plain.csv").displacement;
  std::set<Eigen::Index> found;
  for (const nlohmann::json& outlier :
       with_outliers["diagnostics"]["outliers"]) {
    found.insert(outlier["point"].get<Eigen::Index>());
  }
  for (Eigen::Index point = 0; point < gross.cols(); ++point) {
    EXPECT_TRUE(gross.col(point).isZero(0) || found.count(point) == 1) << point;
  }
  // 30 outliers were added.  One measurement in twenty has one more by chance.
  EXPECT_GE(found.size(), 30U);
  EXPECT_LE(found.size(), 31U);
  Simulate(
      "--points=1000 --noise_sd=5e-5 --correlation_length=0.4 --out=smooth.csv "
      "--seed=5");
  WriteScene("smooth.csv", force);
  const nlohmann::json smooth = Estimate();
  ExpectWithinThreeErrors(smooth);
  // Noise that neighbours share counts as fewer measurements, so that the
  // standard error is larger.
  EXPECT_GT(
      smooth["standard_error"]["youngs_modulus"],
      1.5 * with_outliers["standard_error"]["youngs_modulus"].get<double>());
}

TEST_F(SyntheticMeasurements, OfQuadraticElementsAreThoseOfTheirFunctions) {
  Succeed(
      "generate plate --cells=8 --elements=tri3 --ends=grips "
      "--elongation=-0.02 --out=plate.vtu");
  const std::string force =
      PrintedForce(Simulate("--order=2 --points=400 --out=points.csv"));
  EXPECT_LT(std::atof(force.c_str()), 0);
  WriteScene("points.csv", force);
  ExpectExact(Estimate("--order=2 --origin=computed"));
}

TEST_F(SyntheticMeasurements, OfAnUniformStressHaveItsForce) {
  Succeed(
      "generate rectangle --size=4,2 --cells=5,3 --thickness=0.5 "
      "--out=strip.vtu");
  testing::WriteText(folder_ / "strip.json", R"({
    "mesh": "strip.vtu", "supports": [
      {"nodes": {"box": [[0, 0], [0, 2]]}, "components": "x"},
      {"nodes": {"box": [[0, 0], [0, 0]]}, "components": "y"},
      {"nodes": {"box": [[4, 0], [4, 2]]}, "components": "x",
       "displacement": [0.01, 0]}],
    "cases": [{"loads": []},
              {"loads": [{"type": "nodal_force", "value": [3, 0],
                          "nodes": {"box": [[4, 2], [4, 2]]}}]}]})");
  const testing::ProgramRun run =
      Succeed("simulate strip.json --youngs=1000 --nu=0.3 --out=m.vtu");
  // The stress 1000 x 0.01 / 4 acts on the area 2 x 0.5.  In the second load
  // case a load of 3 acts on the support, whose own force is smaller by that.
  const std::string words = ": force of the displaced supports (";
  EXPECT_THAT(run.output,
              ::testing::MatchesRegex("load case 1: .*\nload case 2: .*\n"));
  const auto force = [&](const std::string& load_case) {
    return std::atof(run.output
                         .substr(run.output.find(load_case + words) +
                                 (load_case + words).size())
                         .c_str());
  };
  EXPECT_NEAR(force("load case 1"), 2.5, 1e-8);
  EXPECT_NEAR(force("load case 2"), 2.5 - 3, 1e-8);
  Refuse("simulate strip.json --youngs=1000 --nu=0.3 --out=m2.vtu",
         "standard output cannot be written", ">/dev/full");
  Refuse("simulate strip.json --youngs=1000 --nu=0.3 --out=m.csv",
         "--out=m.csv: strip.json has 2 load cases, and a table holds only "
         "one; give --out=FILE.vtu, or make a scene of each load case");
  Succeed("generate plate --out=plate.vtu");
  EXPECT_EQ(Simulate("--out=m.csv").output, "");
}

TEST_F(SyntheticMeasurements, HaveTheNoiseThatWasAskedFor) {
  MakePlate();
  Simulate("--noise_sd=0.01 --out=noisy.csv");
  const PointsFile exact = Points("exact.csv");
  const PointsFile noisy = Points("noisy.csv");
  const Scene plate = SceneOf("plate.vtu");
  EXPECT_EQ(exact.positions, plate.mesh.nodes);
  EXPECT_EQ(noisy.positions, plate.mesh.nodes);
  const Eigen::ArrayXXd noise = noisy.displacement - exact.displacement;
  const double n = double(noise.size());
  EXPECT_NEAR(noise.square().mean() / 1e-4, 1, 4 * std::sqrt(2 / n));
  EXPECT_TRUE((noise != 0).all());
  // In a scene, unlike a table of points, the supports stay exact.
  Simulate("--noise_sd=0.01 --out=noisy.vtu");
  Simulate("--out=exact.vtu");
  const Scene scene = SceneOf("noisy.vtu");
  const Eigen::ArrayXXd of_nodes =
      scene.load_cases[0].displacement -
      SceneOf("exact.vtu").load_cases[0].displacement;
  EXPECT_TRUE(((of_nodes == 0) == scene.supports.held).all());
  EXPECT_TRUE((scene.supports.held || (of_nodes - noise).abs() < 1e-15).all());
  Simulate("--noise_sd=0.01 --seed=2 --out=other.csv");
  EXPECT_NE(Points("other.csv").displacement, noisy.displacement);
  // --noise gives the norm of the noise relative to that of all that is
  // measured.
  Simulate("--noise=0.1 --out=relative.csv");
  EXPECT_NEAR((Points("relative.csv").displacement - exact.displacement).norm(),
              0.1 * exact.displacement.norm(), 1e-12);
}

TEST_F(SyntheticMeasurements, MoveAsRigidBodies) {
  MakePlate();
  const PointsFile exact = Points("exact.csv");
  for (const std::string flags :
       {"--out=moved.csv", "--noise_sd=1e-3 --out=moved.csv"}) {
    Simulate(flags);
    const PointsFile still = Points("moved.csv");
    Simulate(flags + " --rigid_motion=0.1,-0.2,0.5");
    const PointsFile moved = Points("moved.csv");
    const Eigen::MatrixXd before = exact.positions + exact.displacement;
    Eigen::MatrixXd motion =
        Eigen::Rotation2Dd(0.5).toRotationMatrix() * before - before;
    motion.colwise() += Eigen::Vector2d(0.1, -0.2);
    EXPECT_LT((moved.displacement - still.displacement - motion).norm(), 1e-12);
  }
  Succeed("generate cuboid --out=cuboid.vtu");
  const std::string simulate =
      "simulate cuboid.vtu --youngs=1e4 --nu=0.3 --points=50 --out=";
  Succeed(simulate + "still.csv");
  // A third of a turn about (1, 1, 1) takes x to y, y to z and z to x.
  const std::string third = std::to_string(2 * M_PI / 3 / std::sqrt(3));
  Succeed(simulate + "moved.csv --rigid_motion=1,2,3," + third + "," + third +
          "," + third);
  const PointsFile still = Points("still.csv", 3);
  const PointsFile moved = Points("moved.csv", 3);
  EXPECT_EQ(still.positions, moved.positions);
  EXPECT_EQ(still.positions.cols(), 50);
  for (Eigen::Index point = 0; point < 50; ++point) {
    const Eigen::Vector3d x = still.positions.col(point);
    const Eigen::Vector3d y = x + still.displacement.col(point);
    const Eigen::Vector3d expected(1 + y(2), 2 + y(0), 3 + y(1));
    // std::to_string gives the angle to seven digits.
    EXPECT_LT((x + moved.displacement.col(point) - expected).norm(),
              1e-6 * y.norm());
  }
}

TEST_F(SyntheticMeasurements, OfAFileSayWhetherLinearElasticityMadeThem) {
  MakePlate();
  Simulate("--out=still.vtu");
  EXPECT_EQ(SceneOf("still.vtu").origin, Origin::kComputed);
  Simulate("--rigid_motion=0.1,-0.2,0.5 --out=moved.vtu");
  EXPECT_EQ(SceneOf("moved.vtu").origin, Origin::kMeasured);
}

TEST_F(SyntheticMeasurements, HaveTheOutliersThatWereAskedFor) {
  MakePlate();
  Simulate("--points=300 --noise_sd=1e-3 --out=plain.csv");
  Simulate("--points=300 --noise_sd=1e-3 --outliers=0.1 --out=gross.csv");
  const Eigen::ArrayXd sizes =
      (Points("gross.csv").displacement - Points("plain.csv").displacement)
          .colwise()
          .norm()
          .transpose()
          .array() /
      1e-3;
  EXPECT_EQ((sizes > 20 - 1e-6 && sizes < 100 + 1e-6).count(), 30);
  EXPECT_EQ((sizes == 0).count(), 270);
}

TEST_F(SyntheticMeasurements, AreInTheOrderOfTheFile) {
  testing::WriteText(
      folder_ / "mesh.vtk",
      "# vtk DataFile Version 3.0\nsquare\nASCII\n"
      "DATASET UNSTRUCTURED_GRID\nPOINTS 9 double\n"
      "1 0 0  2 1 0  1 1 0  1 2 0  0 1 0  0 0 0  2 0 0  2 2 0  0 2 0\n"
      "CELLS 2 14\n6 5 6 7 0 1 2\n6 5 7 8 2 3 4\nCELL_TYPES 2\n22 22\n");
  testing::WriteText(folder_ / "scene.json", R"({"mesh": "mesh.vtk",
    "model": "plane_stress", "thickness": 0.1,
    "supports": [{"nodes": {"box": [[0, 0], [0, 2]]}}],
    "cases": [{"loads": [{"type": "traction", "value": [3e8, 1e8],
               "surface": {"box": [[2, 0], [2, 2]]}}]}]})");
  Succeed("simulate scene.json --youngs=7e10 --nu=0.33 --out=nodes.csv");
  const PointsFile nodes = Points("nodes.csv");
  Eigen::MatrixXd positions(2, 9);
  positions << 1, 2, 1, 1, 0, 0, 2, 2, 0, 0, 1, 1, 2, 1, 0, 0, 2, 2;
  EXPECT_EQ(nodes.positions, positions);
  EXPECT_TRUE(((nodes.displacement.array() == 0).colwise().all() ==
               (positions.row(0).array() == 0))
                  .all());
}

TEST_F(SyntheticMeasurements, RefuseWrongFlags) {
  MakePlate();
  const std::string vtu = "simulate plate.vtu --youngs=1 --nu=0 --out=a.vtu ";
  const std::string csv = "simulate plate.vtu --youngs=1 --nu=0 --out=a.csv ";
  Refuse(csv + "--noise_sd=0", "--noise_sd=0; it must be positive");
  Refuse(csv + "--noise_sd=1 --noise=0.1",
         "--noise_sd=1; --noise is given as well, so give only one of them");
  Refuse(csv + "--noise_sd=1 --noise_law=uniform",
         "--noise_law=uniform; the noise of --noise_sd is gaussian");
  Refuse(csv + "--correlation_length=1",
         "--correlation_length=1; it belongs to noise of a given standard "
         "deviation");
  Refuse(csv + "--noise_sd=1 --correlation_length=-1",
         "--correlation_length=-1; it must be positive");
  Refuse(csv + "--noise_sd=1 --correlation_length=1e-9",
         "--correlation_length=1e-09 is too short for the extent");
  Refuse(csv + "--outliers=1.5", "--outliers=1.5; it must be from 0 to 1");
  Refuse(csv + "--outliers=0.1",
         "--outliers=0.1; their size is a multiple of the noise, so give "
         "--noise_sd or --noise");
  Refuse(csv + "--rigid_motion=1,2",
         "--rigid_motion=1,2; it needs three finite numbers, as in "
         "--rigid_motion=1,2,3");
  Refuse(csv + "--rigid_motion=1e60,0,0",
         "plate.vtu: the simulated displacement has the magnitude 1e+60");
  Refuse(csv + "--points=0", "--points=0; it must be from 1 to 10000000");
  Refuse(vtu + "--points=10",
         "--points=10; points are written as a table, so give --out=FILE.csv");
  Refuse("simulate plate.vtu --youngs=1 --nu=0 --out=a.txt",
         "--out=a.txt; the name must end in .vtu for a scene, or in .csv for a "
         "table of points");
  Refuse("simulate plate.vtu --youngs=1 --nu=0",
         "or --out=FILE.csv for a table");
  Refuse("estimate plate.vtu --out=a.csv", "the name must end in .vtu");
  Succeed("generate cuboid --out=cuboid.vtu");
  Refuse(
      "simulate cuboid.vtu --youngs=1 --nu=0 --out=a.csv "
      "--rigid_motion=1,2,3",
      "it needs six finite numbers, as in --rigid_motion=1,2,3,4,5,6");
}

TEST_F(SyntheticMeasurements, RefuseWrongPlates) {
  const std::string plate = "generate plate --out=a.vtu ";
  EXPECT_EQ(Succeed(plate).output, "3025 nodes, 2916 quadrilaterals\n");
  Refuse(plate + "--ends=pins", "--ends=pins; it must be traction or grips");
  Refuse(plate + "--ends=grips --force=3",
         "--force=3 is not for --ends=grips, which move by --elongation; leave "
         "it out");
  Refuse(plate + "--elongation=3",
         "--elongation=3 is not for --ends=traction; leave it out, or give "
         "--ends=grips");
  Refuse(plate + "--ends=grips --elongation=0",
         "--elongation=0; its magnitude must be from 1e-50 to 1e+50");
  Refuse(plate + "--cells=3,4",
         "--cells=3,4; it needs one integer below 2^31, as in --cells=1");
  Refuse(plate + "--cells=1", "--cells=1; it must be from 2 to 1414");
  Refuse(plate + "--size=3", "--size=3; it needs two finite numbers, as in");
  Refuse(
      plate + "--size=2,2",
      "--hole=2.5; a plate of size 2,2 takes a hole of radius 2e-05 to 1.98");
  Refuse(plate + "--force=1,2", "--force=1,2; it needs one finite number, as");
  Refuse(plate + "--elements=hex8",
         "--elements=hex8; a plate is made of tri3 or quad4");
  Refuse(plate + "--model=3d", "--model=3d; a plate is in plane_stress or");
  Refuse(plate + "--length=3", "generate plate takes no flag --length");
  for (const std::string flag :
       {"--hole=1", "--ends=traction", "--elongation=1"}) {
    for (const std::string other : {"cuboid", "rectangle", "organ"}) {
      Refuse("generate " + other + " --out=b.vtu " + flag,
             "generate " + other + " takes no flag --");
    }
  }
}

TEST_F(SyntheticMeasurements, OfPlatesHaveTheOptionsOfTheFlags) {
  Succeed(
      "generate plate --size=4,3 --hole=1 --cells=6 --elements=tri3 "
      "--force=-20 --model=plane_strain --thickness=0.5 --out=plate.vtu");
  const Scene scene = SceneOf("plate.vtu");
  EXPECT_EQ(scene.mesh.kind, ElementKind::kTri3);
  EXPECT_EQ(scene.mesh.NumElements(), 2 * 6 * 6);
  EXPECT_EQ(scene.mesh.section.model, SectionModel::kPlaneStrain);
  EXPECT_EQ(scene.mesh.section.thickness, 0.5);
  EXPECT_EQ(scene.mesh.nodes.rowwise().maxCoeff(), Eigen::Vector2d(4, 3));
  EXPECT_NEAR(scene.mesh.nodes.colwise().norm().minCoeff(), 1, 1e-14);
  EXPECT_NEAR(
      std::get<NodalForces>(scene.load_cases[0].loads[0]).force.row(0).sum(),
      -20, 1e-12);
  Succeed("generate plate --ends=grips --size=20,9 --out=plate.vtu");
  EXPECT_EQ(SceneOf("plate.vtu").supports.displacement.maxCoeff(), 0.02);
  Succeed("generate plate --ends=grips --elongation=-3 --out=plate.vtu");
  EXPECT_EQ(SceneOf("plate.vtu").supports.displacement.minCoeff(), -3);
}

}  // namespace
}  // namespace elastimate
