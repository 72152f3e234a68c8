// Tests of the commands scene and check.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>
#include <string>

#include "tests/program.h"

namespace elastimate {
namespace {

using Json = nlohmann::json;
using ::testing::HasSubstr;
using ::testing::Not;

// Eight cubes of edge 1 that make up one of edge 2, with its bottom, its top
// and its lower half.
std::string CubesOfAbaqus() {
  std::string text = "*NODE\n";
  const auto node = [](int x, int y, int z) {
    return std::to_string(100 * (x + 1) + 10 * y + z);
  };
  for (int x = 0; x <= 2; ++x) {
    for (int y = 0; y <= 2; ++y) {
      for (int z = 0; z <= 2; ++z) {
        text += node(x, y, z) + ", " + std::to_string(x) + ", " +
                std::to_string(y) + ", " + std::to_string(z) + "\n";
      }
    }
  }
  text += "*ELEMENT, TYPE=C3D8, ELSET=EALL\n";
  int number = 0;
  for (int z = 0; z < 2; ++z) {
    for (int y = 0; y < 2; ++y) {
      for (int x = 0; x < 2; ++x) {
        text += std::to_string(++number);
        for (int up = 0; up < 2; ++up) {
          for (const auto& [dx, dy] :
               {std::pair{0, 0}, {1, 0}, {1, 1}, {0, 1}}) {
            text += ", " + node(x + dx, y + dy, z + up);
          }
        }
        text += "\n";
      }
    }
  }
  text +=
      "*ELSET, ELSET=LOWER, GENERATE\n1, 4\n*ELSET, ELSET=UPPER, "
      "GENERATE\n5, 8\n*NSET, NSET=FIX, GENERATE\n100, 400, 10\n"
      "*SURFACE, NAME=TOP\nUPPER, S2\n";
  return text;
}

class SceneCommand : public testing::ProgramTest {
 protected:
  void SetUp() override {
    testing::ProgramTest::SetUp();
    testing::WriteText(folder_ / "mesh.inp", CubesOfAbaqus());
  }
};

TEST_F(SceneCommand, ListsWhatAMeshOffers) {
  const std::string list = Succeed("scene mesh.inp").output;
  EXPECT_THAT(list, HasSubstr("8 hexahedra (hex8), 27 nodes, from (0, 0, 0) to "
                              "(2, 2, 2)"));
  EXPECT_THAT(list, HasSubstr("set \"FIX\"             9 nodes\n"));
  EXPECT_THAT(list, HasSubstr("set \"TOP\"             9 nodes, 4 faces\n"));
  EXPECT_THAT(list, HasSubstr("set \"LOWER\"           elements with 18 nodes, "
                              "region 1\n"));
  EXPECT_FALSE(std::filesystem::exists(folder_ / "scene.json"));
}

TEST_F(SceneCommand, LeadsFromAMeshToAnEstimate) {
  Succeed("scene mesh.inp --support=fix --force=top,0.5,0,-6 --out=load.json");
  Succeed(
      "simulate load.json --youngs=1000 --nu=0.3 --points=40 "
      "--out=markers.csv");
  Succeed(
      "scene mesh.inp --support=FIX --force=TOP,0.5,0,-6 --points=markers.csv");
  const Json scene = Json::parse(testing::ReadText(folder_ / "scene.json"));
  EXPECT_EQ(scene["mesh"], "mesh.inp");
  EXPECT_EQ(scene["supports"][0]["nodes"]["set"], "FIX");
  const std::string check = Succeed("check scene.json --out=check.vtu").output;
  EXPECT_THAT(check, HasSubstr("held are 9 nodes: ux of 9, uy of 9, uz of 9"));
  EXPECT_THAT(check, HasSubstr("none, the supports hold the specimen"));
  EXPECT_THAT(check,
              HasSubstr("force, resultant (0.5, 0, -6) on an area of 4"));
  EXPECT_THAT(check, HasSubstr("40 points located in elements"));
  EXPECT_THAT(check, Not(HasSubstr("force on supports")));
  EXPECT_TRUE(std::filesystem::exists(folder_ / "check.vtu"));
  const Json report = Succeed(
                          "estimate scene.json --estimator=iterative-fe "
                          "--origin=computed --json=-")
                          .Json();
  EXPECT_NEAR(report["youngs_modulus"].get<double>(), 1000, 0.1);
}

// tests/data/abaqus/README.md
TEST_F(SceneCommand, LeadsFromADeckOfCalculixToItsModuli) {
  const std::filesystem::path data = ELASTIMATE_TEST_DATA "/abaqus";
  for (const std::string name : {"cube.inp", "cube.dat"}) {
    std::filesystem::copy_file(data / name, folder_ / name);
  }
  Succeed("scene cube.inp --support=FIX --points=cube.dat --out=first.json");
  const Json first = Json::parse(testing::ReadText(folder_ / "first.json"));
  EXPECT_EQ(first["cases"][0]["displacement"]["nodes"], "cube.dat");
  testing::WriteText(folder_ / "scene.json", R"({"mesh": "cube.inp",
    "origin": "computed", "supports": [{"nodes": {"set": "FIX"}}],
    "cases": [{"displacement": {"nodes": "cube.dat"},
               "loads": [{"type": "pressure", "value": 30,
                          "surface": {"set": "TOP"}}]}]})");
  EXPECT_THAT(Succeed("check scene.json").output,
              HasSubstr("pressure, resultant (0, 0, -120) on an area of 4"));
  const Json report = Succeed("estimate scene.json --json=-").Json();
  EXPECT_NEAR(report["youngs_modulus"].get<double>(), 1000, 0.01);
  EXPECT_NEAR(report["poisson_ratio"].get<double>(), 0.3, 1e-5);
}

TEST_F(SceneCommand, TellsForceOnSupports) {
  testing::WriteText(folder_ / "scene.json", R"({"mesh": "mesh.inp",
    "supports": [{"nodes": {"set": "FIX"}, "components": "z"}],
    "cases": [{"loads": [
      {"type": "nodal_force", "value": [1, 0, -2], "nodes": {"ids": [0]}},
      {"type": "force", "value": [0, 0, -6], "surface": {"set": "TOP"}}]}]})");
  EXPECT_THAT(Succeed("check scene.json").output,
              HasSubstr("force on supports     (0, 0, -2) of the loads is on 1 "
                        "node held in its direction"));
}

TEST_F(SceneCommand, TellsWhatIsLeftLoose) {
  Succeed("scene mesh.inp --force=TOP,0,0,-6");
  const std::string check = Succeed("check scene.json").output;
  EXPECT_THAT(check, HasSubstr("nothing is held"));
  EXPECT_THAT(check, HasSubstr("the supports let the part of the mesh"));
  EXPECT_THAT(check, HasSubstr("nothing; estimate needs displacements"));
}

TEST_F(SceneCommand, RefusesWhatTheMeshDoesNotHave) {
  Refuse("scene mesh.inp --support=FIXED",
         "mesh.inp: it has nothing of the name 'FIXED'; its names are: FIX");
  Refuse("scene mesh.inp --force=TOP",
         "--force=TOP; it needs the name of a surface and the total force");
  Refuse("scene mesh.inp --force=TOP,1,2", "has 3 components, but 2 are given");
  Refuse("scene mesh.inp --support=FIX --out=scene.vtu",
         "the name must end in .json");
  Refuse("scene mesh.inp --support=FIX --points=none.csv --out=load.json",
         "none.csv");
  Refuse("scene mesh.inp --support=FIX --model=plane_stress --out=load.json",
         "which are solid, but the model is plane_stress");
  Refuse("scene mesh.inp --out=load.json",
         "a first scene needs what is held or loaded; give --support=NAME");
  EXPECT_FALSE(std::filesystem::exists(folder_ / "load.json"));
  Refuse("scene", "scene needs one mesh file; it got none");
  testing::WriteText(folder_ / "scene.json", "{}");
  Refuse("scene mesh.inp --support=FIX", "scene.json is there already");
  EXPECT_EQ(testing::ReadText(folder_ / "scene.json"), "{}");
  Refuse("check", "check needs a scene");
}

// Files of other programs name the command that converts them.
TEST_F(SceneCommand, NamesTheCommandThatConverts) {
  for (const std::string name : {"a.med", "a.xdmf", "a.exo"}) {
    testing::WriteText(folder_ / name, "x");
    Refuse("scene " + name, "meshio convert " + name + " mesh.vtu");
  }
  testing::WriteText(folder_ / "a.cdb", "x");
  Refuse("scene a.cdb", "Archive('a.cdb')");
}

}  // namespace
}  // namespace elastimate
