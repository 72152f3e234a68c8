// Tests of the command line with materials whose stiffness depends on the
// direction.

#include <gtest/gtest.h>

#include <cmath>
#include <nlohmann/json.hpp>
#include <string>
#include <utility>
#include <vector>

#include "elastimate/io/examples/example_scenes.h"
#include "elastimate/io/scene/scene_reader.h"
#include "elastimate/io/vtk/vtu_writer.h"
#include "tests/program.h"

namespace elastimate {
namespace {

using Json = nlohmann::json;

Json ParametersFile(const std::vector<std::pair<std::string, double>>& values) {
  Json list = Json::array();
  for (const auto& [name, value] : values) {
    list.push_back({{"name", name}, {"value", value}});
  }
  return {{"parameters", list}};
}

class AnisotropicCommand : public testing::ProgramTest {
 protected:
  void SetUp() override {
    testing::ProgramTest::SetUp();
    testing::WriteText(folder_ / "fibres.json",
                       ParametersFile({{"youngs_modulus_L", 9e4},
                                       {"youngs_modulus_T", 3e4},
                                       {"poisson_ratio_LT", 0.32},
                                       {"poisson_ratio_TT", 0.4},
                                       {"shear_modulus_LT", 1.5e4}})
                           .dump());
  }

  void ExpectFibres(const Json& report) const {
    EXPECT_EQ(report["status"], "ok") << report["message"];
    EXPECT_EQ(report["material"]["law"], "transversely_isotropic");
    const std::vector<double> truth = {9e4, 3e4, 0.32, 0.4, 1.5e4};
    ASSERT_EQ(report["parameters"].size(), truth.size());
    for (std::size_t i = 0; i < truth.size(); ++i) {
      EXPECT_NEAR(report["parameters"][i]["value"].get<double>() / truth[i], 1,
                  1e-6);
      EXPECT_TRUE(report["parameters"][i]["standard_error"].is_number());
    }
  }
};

TEST_F(AnisotropicCommand, SimulatesAndEstimatesFibres) {
  Succeed("generate cuboid --out=block.vtu");
  Succeed(
      "simulate block.vtu --material=transversely_isotropic --axis=1,1,0 "
      "--parameters=fibres.json --out=m.vtu");
  for (const std::string estimator :
       {"closed-form", "bounded", "virtual-fields", "iterative-fe", "auto"}) {
    const Json report =
        Succeed(
            "estimate m.vtu --material=transversely_isotropic --axis=-2,-2,0 "
            "--json=- --estimator=" +
            estimator)
            .Json();
    ExpectFibres(report);
    ASSERT_EQ(report["stiffness"].size(), 1);
    const Json& stiffness = report["stiffness"][0];
    EXPECT_TRUE(stiffness["region"].is_null());
    // c_66 is G_LT, the shear modulus along the axis, and c_44 is G_TT, the one
    // across it.
    EXPECT_NEAR(stiffness["value"][5][5].get<double>(), 1.5e4, 0.1);
    EXPECT_NEAR(stiffness["value"][3][3].get<double>(), 3e4 / 2.8, 0.1);
    EXPECT_TRUE(stiffness["standard_error"][0][0].is_number());
  }
}

// The scene.json names a cell array, which gives each element another axis.
TEST_F(AnisotropicCommand, TakesAnAxisFromACellArray) {
  const Scene scene = CuboidScene({});
  Eigen::MatrixXd fibre(3, scene.mesh.NumElements());
  for (Eigen::Index e = 0; e < fibre.cols(); ++e) {
    const double angle = scene.mesh.nodes(0, scene.mesh.elements(0, e));
    fibre.col(e) << 2 * std::cos(angle), 2 * std::sin(angle), 0;
  }
  Fields fields = SceneFields(scene);
  fields.cell.push_back({"fibre", fibre});
  fields.point.push_back(
      {"held", scene.supports.held.colwise().any().cast<double>()});
  const auto scene_with = [&](const std::string& mesh,
                              const std::string& displacement) {
    return R"({"origin": "computed", "mesh": ")" + mesh +
           R"(", "materials": [{"law": "transversely_isotropic",
              "axis": "fibre"}], "supports": [{"nodes": {"array": "held"}}],
              "cases": [{)" +
           displacement +
           R"("loads": [{"type": "nodal_force", "nodes": {"array": "free"},
              "value": [1, 2, -30]}]}]})";
  };
  fields.point.push_back(
      {"free", Eigen::RowVectorXd::Ones(scene.mesh.NumNodes())});
  WriteVtu(folder_ / "block.vtu", scene.mesh, fields);
  testing::WriteText(folder_ / "scene.json", scene_with("block.vtu", ""));
  Succeed("simulate scene.json --parameters=fibres.json --out=m.csv");
  testing::WriteText(
      folder_ / "measured.json",
      scene_with("block.vtu", R"("displacement": {"points": "m.csv"}, )"));
  ExpectFibres(
      Succeed("estimate measured.json --estimator=iterative-fe --json=-")
          .Json());
}

// Data that are written into a result can be read from it again: the cell array
// of axes that a scene.json names, and the array "observed" of a mesh file.
TEST_F(AnisotropicCommand, SimulatesWhatCanBeReadAgain) {
  const Scene scene = CuboidScene({});
  const Mesh& mesh = scene.mesh;
  Fields fields = SceneFields(scene);
  Eigen::MatrixXd fibre = Eigen::MatrixXd::Ones(3, mesh.NumElements());
  fibre.row(2).setLinSpaced(-1, 1);
  const Eigen::RowVectorXd seen =
      (mesh.nodes.row(0).array() > 0.3).cast<double>();
  fields.cell.push_back({"fibre", fibre});
  fields.point.push_back({"observed", seen});
  WriteVtu(folder_ / "block.vtu", mesh, fields);
  const auto write_scene = [&](const std::string& of_mesh) {
    testing::WriteText(
        folder_ / "scene.json",
        R"({"origin": "computed", "mesh": ")" + of_mesh + R"(", "materials":
            [{"law": "transversely_isotropic", "axis": "fibre"}],
            "supports": [{"nodes": {"box": [[-1,-1,-1],[2,2,1e-9]]}}],
            "cases": [{)" +
            (of_mesh == "m.vtu" ? R"("displacement": {"array": "displacement"},
                                     )"
                                : "") +
            R"("loads": [{"type": "nodal_force", "nodes": "free",
                          "value": [1, 2, -30]}]}]})");
  };
  write_scene("block.vtu");
  Succeed("simulate scene.json --parameters=fibres.json --out=m.vtu");
  write_scene("m.vtu");
  ExpectFibres(
      Succeed("estimate scene.json --estimator=iterative-fe --json=-").Json());

  Succeed("simulate block.vtu --youngs=1e4 --nu=0.3 --out=seen.vtu");
  const Scene measured =
      ReadScene({folder_ / "seen.vtu"}, Measurement::kRequired).scene;
  const ComponentMask& observed = measured.load_cases[0].observed;
  ASSERT_EQ(observed.cols(), mesh.NumNodes());
  for (Eigen::Index node = 0; node < mesh.NumNodes(); ++node) {
    EXPECT_EQ(observed(0, node), seen(node) != 0);
  }
}

TEST_F(AnisotropicCommand, SaysWhichParametersAreOfNoMaterial) {
  testing::WriteText(folder_ / "wrong.json",
                     ParametersFile({{"youngs_modulus_L", 1e4},
                                     {"youngs_modulus_T", 9e4},
                                     {"poisson_ratio_LT", 0.5},
                                     {"poisson_ratio_TT", 0.4},
                                     {"shear_modulus_LT", 1.5e4}})
                         .dump());
  Succeed("generate cuboid --out=block.vtu");
  for (const std::string command :
       {"simulate block.vtu --out=m.vtu", "plan block.vtu"}) {
    Refuse(command +
               " --material=transversely_isotropic --axis=0,0,1 "
               "--parameters=wrong.json",
           "wrong.json: the stiffness is not positive definite");
  }
}

// The block is pulled aside; its fibres run along this axis.
std::string SceneOfFibres(const std::string& axis,
                          const std::string& displacement) {
  return R"({"origin": "computed", "mesh": "block.vtu", "materials":
              [{"law": "transversely_isotropic", "axis": )" +
         axis +
         R"(}], "supports": [{"nodes": {"box": [[-1, -1, -1], [2, 2, 0.001]]}}],
              "cases": [{)" +
         displacement +
         R"("loads": [{"type": "force", "value": [3, 1, -5],
              "surface": {"box": [[-1, -1, 0.39], [2, 2, 1]]}}]}]})";
}

TEST_F(AnisotropicCommand, FindsAnAxis) {
  Succeed("generate cuboid --out=block.vtu");
  testing::WriteText(folder_ / "known.json", SceneOfFibres("[1, -2, 2]", ""));
  Succeed(
      "simulate known.json --parameters=fibres.json --noise=0.001 --out=m.csv");
  const std::string measured = R"("displacement": {"points": "m.csv"}, )";
  testing::WriteText(folder_ / "known.json",
                     SceneOfFibres("[1, -2, 2]", measured));
  testing::WriteText(folder_ / "free.json",
                     SceneOfFibres("\"free\"", measured));
  for (const std::string scene : {"free.json", "known.json --axis=free"}) {
    const Json report =
        Succeed("estimate " + scene + " --estimator=auto --json=-").Json();
    EXPECT_EQ(report["status"], "ok") << report["message"];
    EXPECT_EQ(report["material"]["law"], "transversely_isotropic_free_axis");
    ASSERT_EQ(report["axes"].size(), 1);
    const Json& axis = report["axes"][0];
    EXPECT_TRUE(axis["region"].is_null());
    const double error = axis["standard_error_deg"].get<double>();
    EXPECT_GT(error, 0);
    EXPECT_LT(error, 0.5);
    const std::vector<double> truth = {1.0 / 3, -2.0 / 3, 2.0 / 3};
    for (std::size_t i = 0; i < truth.size(); ++i) {
      EXPECT_NEAR(axis["direction"][i].get<double>(), truth[i],
                  5 * error / 57.3);
    }
    EXPECT_EQ(report["parameters"].size(), 7);
    EXPECT_EQ(report["covariance"].size(), 7);
  }
  const std::string text =
      Succeed("estimate free.json --estimator=reduced-fe").output;
  EXPECT_NE(text.find("axis                  0.33"), std::string::npos) << text;
  EXPECT_NE(text.find(" degrees\n"), std::string::npos) << text;
  EXPECT_EQ(text.find("w_y"), std::string::npos) << text;
  // An axis that --axis gives overrides "free", so that no axis is estimated.
  const Json known = Succeed(
                         "estimate free.json --axis=1,-2,2 "
                         "--estimator=reduced-fe --json=-")
                         .Json();
  EXPECT_EQ(known["material"]["law"], "transversely_isotropic");
  EXPECT_EQ(known["axes"].size(), 0);
  Refuse("estimate free.json --estimator=closed-form",
         "use --estimator=iterative-fe");
}

TEST_F(AnisotropicCommand, ChoosesTheLaw) {
  Succeed("generate cuboid --out=block.vtu");
  Succeed(
      "simulate block.vtu --material=transversely_isotropic --axis=1,-2,2 "
      "--parameters=fibres.json --noise=0.01 --out=fibres.vtu");
  Succeed("simulate block.vtu --youngs=5e4 --nu=0.3 --noise=0.01 --out=m.vtu");
  const Json report =
      Succeed("estimate fibres.vtu --material=auto --estimator=auto --json=-")
          .Json();
  EXPECT_EQ(report["status"], "ok") << report["message"];
  ASSERT_EQ(report["laws"].size(), 3);
  EXPECT_EQ(report["laws"][0]["law"], "transversely_isotropic_free_axis");
  EXPECT_EQ(report["laws"][0]["num_parameters"], 7);
  EXPECT_EQ(report["laws"][0]["bic_difference"], 0);
  EXPECT_EQ(report["material"]["law"], report["laws"][0]["law"]);
  const Json about_axis = Succeed(
                              "estimate fibres.vtu --material=auto "
                              "--axis=1,-2,2 --estimator=auto --json=-")
                              .Json();
  EXPECT_EQ(about_axis["material"]["law"], "transversely_isotropic");
  const Json isotropic =
      Succeed("estimate m.vtu --material=auto --estimator=auto --json=-")
          .Json();
  EXPECT_EQ(isotropic["material"]["law"], "isotropic");
  EXPECT_TRUE(isotropic["youngs_modulus"].is_number());
  const std::string text =
      Succeed("estimate m.vtu --material=auto --estimator=auto").output;
  EXPECT_NE(text.find("law chosen            isotropic (2 parameters, chi^2"),
            std::string::npos)
      << text;
  for (const auto& [flags, says] :
       std::vector<std::pair<std::string, std::string>>{
           {"--estimator=auto --nu=0.3", "without known values or bounds of E"},
           {"--estimator=closed-form", "compares fits of displacements"}}) {
    Refuse("estimate m.vtu --material=auto " + flags, says);
  }
  Refuse("simulate block.vtu --material=auto --youngs=1 --nu=0 --out=a.vtu",
         "it must be one of isotropic");
  Succeed("generate plate --cells=10 --out=plate.vtu");
  Succeed("simulate plate.vtu --youngs=1 --nu=0 --out=p.vtu");
  Refuse("estimate p.vtu --material=auto --estimator=auto",
         "in three dimensions");
}

TEST_F(AnisotropicCommand, EstimatesALamina) {
  testing::WriteText(folder_ / "lamina.json",
                     ParametersFile({{"youngs_modulus_1", 1.4e5},
                                     {"youngs_modulus_2", 1e4},
                                     {"poisson_ratio_12", 0.3},
                                     {"shear_modulus_12", 5e3}})
                         .dump());
  Succeed("generate plate --cells=10 --out=plate.vtu");
  Succeed(
      "simulate plate.vtu --material=orthotropic --axis=1,0.5 "
      "--parameters=lamina.json --out=m.vtu");
  const Json report =
      Succeed(
          "estimate m.vtu --material=orthotropic --axis=1,0.5,0 "
          "--estimator=iterative-fe --json=-")
          .Json();
  EXPECT_EQ(report["status"], "ok") << report["message"];
  EXPECT_NEAR(report["parameters"][0]["value"].get<double>(), 1.4e5, 1);
  EXPECT_NEAR(report["parameters"][2]["value"].get<double>(), 0.3, 1e-5);
  EXPECT_NEAR(report["parameters"][3]["value"].get<double>(), 5e3, 0.1);
  Refuse("estimate m.vtu --material=orthotropic --axis=1,0,1",
         "out of the plane");
}

TEST_F(AnisotropicCommand, RefusesWhatIsWrong) {
  Succeed("generate cuboid --out=block.vtu");
  for (const auto& [flags, says] :
       std::vector<std::pair<std::string, std::string>>{
           {"--material=wood", "it must be one of isotropic, transversely"},
           {"--material=orthotropic",
            "has no axes; give two directions, by \"axes\" or --axis"},
           {"--material=transversely_isotropic",
            "has no axis; give its direction, by \"axis\" or --axis"},
           {"--material=orthotropic --axis=1,0,0", "its law takes 2"},
           {"--material=orthotropic --axis=1,0,0,1,1,0", "not orthogonal"},
           {"--material=transversely_isotropic --axis=0,0,0", "length 0"},
           {"--axis=1,0,0", "alike in all directions"},
           {"--axis=free", "the law is isotropic, whose axis cannot be found"},
           {"--material=orthotropic --axis=free",
            "is only for transversely_isotropic"},
           {"--material=transversely_isotropic --axis=1", "it needs three"},
           {"--material=transversely_isotropic --axis=1,0,0",
            "by --parameters=FILE.json"}}) {
    Refuse("simulate block.vtu --youngs=1 --nu=0 --out=a.vtu " + flags, says);
  }
  for (const auto& [material, says] :
       std::vector<std::pair<std::string, std::string>>{
           {R"({"law": "transversely_isotropic", "axis": "fibre"})",
            "materials[0].axis is \"fibre\", but 'block.vtu' has no such cell"},
           {R"({"law": "transversely_isotropic", "axis": [1, 0]})",
            "materials[0].axis"},
           {R"({"law": "transversely_isotropic", "axis": 5})",
            "axis must be a direction of 3 numbers, the name of a cell array, "
            "or \"free\""},
           {R"({"law": "anisotropic", "axis": "free"})",
            "materials[0].axis is \"free\", but the law is anisotropic"},
           {R"({"law": "transversely_isotropic", "axis": "free",
                "axes": [[1, 0, 0]]})",
            "materials[0].axes is given beside"},
           {R"({"law": "transversely_isotropic", "axis": [1, 0, 0],
                "axes": [[1, 0, 0]]})",
            "materials[0].axes is given beside"},
           {R"({"law": "orthotropic", "axis": [1, 0, 0],
                "known": {"youngs_modulus": 3}})",
            "materials[0].known"}}) {
    testing::WriteText(
        folder_ / "scene.json",
        R"({"mesh": "block.vtu", "supports": [{"nodes": {"ids": [0, 1, 2, 3]}}],
            "cases": [{"loads": []}], "materials": [)" +
            material + "]}");
    Refuse("simulate scene.json --youngs=1 --nu=0 --out=a.vtu", says);
  }
}

}  // namespace
}  // namespace elastimate
