// Tests of the command line with several materials.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <sstream>
#include <string>
#include <utility>
#include <vector>

#include "tests/apps/region_scene.h"
#include "tests/program.h"

namespace elastimate {
namespace {

using Json = nlohmann::json;
using ::testing::HasSubstr;
using ::testing::Not;

class MaterialsCommand : public testing::ProgramTest {
 protected:
  void SetUp() override {
    testing::ProgramTest::SetUp();
    testing::WriteRegions(folder_ / "block.vtu");
    testing::WriteText(folder_ / "truth.json", Parameters().dump());
  }

  // These are E and nu of the regions 1, 2 and 3.
  static Json Parameters() {
    Json list = Json::array();
    for (int region = 1; region <= 3; ++region) {
      list.push_back({{"name", "youngs_modulus"},
                      {"region", region},
                      {"value", 1e4 * region}});
      list.push_back({{"name", "poisson_ratio"},
                      {"region", region},
                      {"value", 0.1 + 0.1 * region}});
    }
    return {{"parameters", list}};
  }

  static void ExpectTruth(const Json& report, double tolerance) {
    const Json truth = Parameters()["parameters"];
    ASSERT_EQ(report["parameters"].size(), truth.size());
    for (std::size_t i = 0; i < truth.size(); ++i) {
      const Json& parameter = report["parameters"][i];
      EXPECT_EQ(parameter["name"], truth[i]["name"]);
      EXPECT_EQ(parameter["region"], truth[i]["region"]);
      const double value = truth[i]["value"];
      EXPECT_NEAR(parameter["value"].get<double>() / value, 1, tolerance);
    }
  }
};

// A closed form: a column of Hooke's law is as stiff as E, and becomes narrower
// by nu, whatever the law is called that turns with it.
TEST_F(MaterialsCommand, DrawsTheCurveOfAMaterial) {
  const std::string corotated =
      "materials --curve=corotated,youngs_modulus=10,poisson_ratio=0.25";
  std::istringstream lines(Succeed(corotated).output);
  std::string line;
  std::getline(lines, line);
  EXPECT_THAT(line, HasSubstr("stretch     uniaxial  equibiaxial"));
  int count = 0;
  for (double stretch = 0; lines >> stretch; std::getline(lines, line)) {
    double stress = 0;
    lines >> stress;
    EXPECT_NEAR(stress, 10 * (stretch - 1), 1e-5 * std::abs(stress));
    ++count;
  }
  EXPECT_EQ(count, 26);
  EXPECT_EQ(Succeed(corotated + " --out=curve.csv").output, "");
  const std::string table = testing::ReadText(folder_ / "curve.csv");
  EXPECT_EQ(table.rfind("stretch,uniaxial,equibiaxial,pure_shear,simple_shear,"
                        "volumetric\n0.5,-5",
                        0),
            0U)
      << table;
  // Where the law gives way there is a dash.
  EXPECT_THAT(Succeed("materials --curve=st_venant_kirchhoff,"
                      "youngs_modulus=1,poisson_ratio=0.45")
                  .output,
              HasSubstr(" - "));
}

TEST_F(MaterialsCommand, RefusesACurveOfNoMaterial) {
  Refuse("materials --curve=rubber", "the first part must be a law");
  Refuse("materials --curve=neo_hookean,youngs_modulus=1",
         "needs poisson_ratio as well");
  Refuse("materials --curve=neo_hookean,youngs_modulus=1,poisson_ratio=0.5",
         "poisson_ratio must be between");
  Refuse("materials --curve=neo_hookean,youngs_modulus", "NAME=NUMBER");
  Refuse("materials --curve=yeoh,c10=1,c10=2", "gives c10 twice");
  Refuse(
      "materials "
      "--curve=neo_hookean,youngs_modulus=1,poisson_ratio=0.3,c10=1",
      "neo_hookean has no parameter c10; leave it out");
  Refuse(
      "materials --curve=neo_hookean,youngs_modulus=1,poisson_ratio=0.3 "
      "--out=curve.txt",
      "the name must end in .csv");
  Refuse("materials --out=laws.csv", "the list of laws is not written");
  EXPECT_FALSE(std::filesystem::exists(folder_ / "curve.txt"));
}

TEST_F(MaterialsCommand, EstimatesLawsOfLargeStrainsFromForces) {
  Succeed(
      "simulate block.vtu --material=neo_hookean --youngs=1e4 --nu=0.3 "
      "--out=m.vtu");
  for (const std::string estimator :
       {"closed-form", "bounded", "virtual-fields"}) {
    const std::string command =
        "estimate m.vtu --material=neo_hookean --estimator=" + estimator;
    const Json report = Succeed(command + " --json=- --out=out.vtu").Json();
    EXPECT_NEAR(report["parameters"][0]["value"].get<double>(), 1e4, 1e-4);
    EXPECT_NEAR(report["parameters"][1]["value"].get<double>(), 0.3, 1e-8);
    EXPECT_THAT(report["findings"].dump(), Not(HasSubstr("deformation")));
  }
  Refuse("estimate m.vtu --material=neo_hookean --estimator=reduced-fe",
         "the law neo_hookean is for large strains");
  Refuse("simulate block.vtu --material=yeoh --youngs=1 --nu=0.3 --out=y.vtu",
         "the law yeoh of the scene has c10, c20, c30, bulk_modulus");
  Refuse("plan m.vtu --material=neo_hookean --youngs=1e4 --nu=0.3",
         "the law neo_hookean is for large strains");
}

// The corotated law stretches as Hooke's law does, by E times the strain times
// the undeformed area of 1 x 0.4.
TEST_F(MaterialsCommand, SimulatesLargeStrains) {
  const auto write_pull = [&](const std::string& law, double displacement) {
    const Json materials = {{{"law", law}}};
    const auto support = [](Json box, const std::string& components, double x) {
      return Json{{"nodes", {{"box", std::move(box)}}},
                  {"components", components},
                  {"displacement", {x, 0, 0}}};
    };
    testing::WriteText(
        folder_ / "pull.json",
        Json{{"mesh", "block.vtu"},
             {"materials", materials},
             {"supports",
              {support({{0, -1, -1}, {0, 2, 2}}, "x", 0),
               support({{-1, 0, -1}, {2, 0, 2}}, "y", 0),
               support({{-1, -1, 0}, {2, 2, 0}}, "z", 0),
               support({{1, -1, -1}, {1, 2, 2}}, "x", displacement)}},
             {"cases", {{{"loads", Json::array()}}}}}
            .dump());
  };
  write_pull("corotated", 0.5);
  const std::string flags = " --youngs=1e4 --nu=0.3 --out=pulled.vtu";
  const std::string output = Succeed("simulate pull.json" + flags).output;
  EXPECT_THAT(output, HasSubstr("force of the displaced supports (2000"));
  // Far beyond what the elements bear nothing is written.
  write_pull("corotated", -1.5);
  std::filesystem::remove(folder_ / "pulled.vtu");
  Refuse("simulate pull.json" + flags, "of the load");
  write_pull("neo_hookean", 0.5);
  Refuse("simulate pull.json --solver=multigrid" + flags, "--solver=cholesky");
  write_pull("yeoh", 0.5);
  Refuse("simulate pull.json" + flags, "by --parameters=FILE.json");
}

TEST_F(MaterialsCommand, SimulatesLargeStrainsOfSmallLoadsAsSmallOnes) {
  const std::string flags = " --youngs=1e12 --nu=0.3 --out=";
  Succeed("simulate block.vtu" + flags + "small.csv");
  Succeed("simulate block.vtu --material=neo_hookean" + flags + "large.csv");
  std::istringstream small(testing::ReadText(folder_ / "small.csv"));
  std::istringstream large(testing::ReadText(folder_ / "large.csv"));
  std::string line;
  std::string other;
  int count = 0;
  while (std::getline(small, line) && std::getline(large, other)) {
    const double expected = std::atof(line.substr(line.rfind(',') + 1).c_str());
    const double actual = std::atof(other.substr(other.rfind(',') + 1).c_str());
    EXPECT_NEAR(actual, expected, 1e-5 * std::abs(expected));
    ++count;
  }
  EXPECT_EQ(count, 109);
}

TEST_F(MaterialsCommand, SimulatesAndEstimatesEachRegion) {
  Succeed(
      "simulate block.vtu --regions=each --parameters=truth.json --out=m.vtu");
  for (const std::string estimator :
       {"closed-form", "bounded", "virtual-fields", "reduced-fe",
        "iterative-fe", "auto"}) {
    const Json report = Succeed(
                            "estimate m.vtu --regions=each --json=- "
                            "--estimator=" +
                            estimator)
                            .Json();
    EXPECT_EQ(report["status"], "ok") << report["message"];
    ExpectTruth(report, 1e-5);
    EXPECT_TRUE(report["youngs_modulus"].is_null());
    EXPECT_EQ(report["material"]["regions"], Json({1, 2, 3}));
    EXPECT_EQ(report["covariance"].size(), 6U);
    EXPECT_EQ(report["error_budget"]["noise"].size(), 6U);
  }
  // A table of an estimate that is not usable gives no numbers of regions.
  Succeed(
      "simulate block.vtu --regions=each --parameters=truth.json --noise=0.05 "
      "--out=noisy.vtu");
  for (const std::string estimator : {"closed-form", "bounded"}) {
    const std::string table =
        Run("estimate noisy.vtu --regions=each --estimator=" + estimator)
            .output;
    EXPECT_THAT(table, HasSubstr("NOT USABLE"));
    EXPECT_THAT(table, Not(HasSubstr("\nregion 1  ")));
  }
  // A model of one material for all three regions does not fit.
  const std::string one =
      Run("estimate m.vtu --estimator=iterative-fe --json=-").output;
  EXPECT_EQ(Json::parse(one)["parameters"].size(), 2U);
  EXPECT_NE(one.find("share one material"), std::string::npos);
}

TEST_F(MaterialsCommand, WritesWhatReportsAndScenesAreReadFrom) {
  Succeed(
      "simulate block.vtu --regions=each --parameters=truth.json --noise=1e-3 "
      "--out=m.vtu");
  const testing::ProgramRun run = Succeed(
      "estimate m.vtu --regions=each --estimator=iterative-fe "
      "--json=report.json --out=r.vtu");
  EXPECT_NE(run.output.find("E of region 2"), std::string::npos) << run.output;
  // `simulate` reads its parameters from a report, and the result of `estimate`
  // is a scene with cell arrays.
  Succeed(
      "simulate r.vtu --regions=each --parameters=report.json --out=again.vtu");
  const std::string result = testing::ReadText(folder_ / "r.vtu");
  for (const std::string name :
       {"youngs_modulus", "poisson_ratio", "strain_energy_density", "region"}) {
    EXPECT_NE(result.find("Name=\"" + name + "\""), std::string::npos) << name;
  }
}

TEST_F(MaterialsCommand, MergesWhatTheMeasurementDoesNotTellApart) {
  Json truth = Parameters();
  for (int i = 0; i < 2; ++i) {
    truth["parameters"][4 + i]["value"] = truth["parameters"][i]["value"];
  }
  testing::WriteText(folder_ / "two.json", truth.dump());
  Succeed(
      "simulate block.vtu --regions=each --parameters=two.json --noise=1e-3 "
      "--out=m.vtu");
  for (const std::string estimator : {"iterative-fe", "auto"}) {
    const testing::ProgramRun run = Succeed(
        "estimate m.vtu --regions=merge --json=r.json --out=o.vtu "
        "--estimator=" +
        estimator);
    EXPECT_NE(run.output.find("merged                regions 1 and 3"),
              std::string::npos)
        << run.output;
    EXPECT_NE(run.output.find("told apart            regions 1, 3 and 2"),
              std::string::npos)
        << run.output;
    const Json report = Json::parse(testing::ReadText(folder_ / "r.json"));
    EXPECT_EQ(report["material"]["regions"], Json({{1, 3}, 2}));
    EXPECT_EQ(report["parameters"].size(), 4U);
    ASSERT_EQ(report["merges"].size(), 2U);
    EXPECT_TRUE(report["merges"][0]["merged"]);
    EXPECT_FALSE(report["merges"][1]["merged"]);
    ASSERT_EQ(report["materials"].size(), 2U);
    for (const Json& material : report["materials"]) {
      EXPECT_EQ(material["determination"], "determined");
    }
    EXPECT_EQ(report["materials"][0]["largest_differences"].size(), 2U);
    if (estimator == "auto") {
      continue;
    }
    double share = 0;
    for (const Json& material : report["materials"]) {
      share += double(material["energy_share"]);
      EXPECT_NEAR(double(material["residual_chi_square"]), 1, 0.5);
    }
    EXPECT_NEAR(share, 1, 1e-9);
    const std::string fields = testing::ReadText(folder_ / "o.vtu");
    for (const std::string name :
         {"residual_chi_square", "residual_correlation", "youngs_modulus"}) {
      EXPECT_NE(fields.find('"' + name + '"'), std::string::npos) << name;
    }
  }
}

TEST_F(MaterialsCommand, ReportsEAndNuOfOneMaterialOfWhichSomethingIsKnown) {
  Succeed("simulate block.vtu --youngs=1e4 --nu=0.3 --noise=0.01 --out=m.vtu");
  for (const std::string material :
       {R"({"known": {"poisson_ratio": 0.3}})",
        R"({"bounds": {"poisson_ratio": [0.1, 0.45]}})",
        R"({"region": [1, 2, 3], "known": {"youngs_modulus": 1e4}})",
        R"({"prior": {"poisson_ratio": {"value": 0.3, "sd": 1e-5}}})"}) {
    SCOPED_TRACE(material);
    testing::WriteText(folder_ / "scene.json",
                       R"({"mesh": "m.vtu", "materials": [)" + material +
                           R"(],
          "supports": [{"nodes": {"box": [[-1,-1,-1],[2,2,1e-9]]}}],
          "cases": [{"displacement": {"array": "displacement"},
                     "loads": [{"type": "nodal_force", "array": "force"}]}]})");
    const Json report =
        Succeed("estimate scene.json --estimator=iterative-fe --json=-").Json();
    const Json& errors = report["standard_error"];
    for (const Json& parameter : report["parameters"]) {
      const std::string name = parameter["name"];
      EXPECT_FALSE(parameter["value"].is_null());
      EXPECT_EQ(report[name], parameter["value"]);
      EXPECT_EQ(errors[name].is_null(), bool(parameter["known"])) << errors;
      if (!errors[name].is_null()) {
        EXPECT_NEAR(double(errors[name]) / double(parameter["standard_error"]),
                    1, 1e-9);
      }
    }
    EXPECT_FALSE(report["shear_modulus"].is_null());
    if (material.find("prior") != std::string::npos) {
      EXPECT_NEAR(double(errors["poisson_ratio"]), 1e-5, 1e-6);
      EXPECT_NEAR(double(report["error_budget"]["prior"]["poisson_ratio"]),
                  1e-5, 1e-6);
    }
  }
}

TEST_F(MaterialsCommand, RefusesToMergeWhatItCannotCompare) {
  Succeed(
      "simulate block.vtu --regions=each --parameters=truth.json --out=m.vtu");
  Refuse("estimate m.vtu --regions=merge", "give --estimator=iterative-fe");
  Refuse("simulate block.vtu --regions=merge --youngs=1 --nu=0 --out=x.vtu",
         "is for the command estimate");
}

TEST_F(MaterialsCommand, TakesWhatTheSceneKnows) {
  Succeed(
      "simulate block.vtu --regions=each --parameters=truth.json --out=m.vtu");
  testing::WriteText(folder_ / "scene.json",
                     R"({"mesh": "m.vtu",
          "materials": [{"region": 1, "known": {"youngs_modulus": 1e4}},
                        {"region": 2},
                        {"region": 3, "bounds": {"poisson_ratio": [0, 0.45]}}],
          "supports": [{"nodes": {"box": [[-1,-1,-1],[2,2,1e-9]]}}],
          "cases": [{"displacement": {"array": "displacement"},
                     "loads": [{"type": "nodal_force", "array": "force"}]}]})");
  for (const std::string estimator : {"reduced-fe", "iterative-fe"}) {
    ExpectTruth(
        Succeed("estimate scene.json --json=- --estimator=" + estimator).Json(),
        1e-5);
  }
  const Json report =
      Succeed("estimate scene.json --estimator=iterative-fe --json=-").Json();
  EXPECT_TRUE(report["parameters"][0]["known"]);
  EXPECT_TRUE(report["parameters"][0]["standard_error"].is_null());
  EXPECT_TRUE(report["covariance"][0][1].is_null());
  EXPECT_FALSE(report["covariance"][1][1].is_null());
  // --nu applies to every material whose nu the scene does not give as known.
  const Json known =
      Run("estimate scene.json --estimator=iterative-fe --nu=0.2 --json=-")
          .Json();
  EXPECT_TRUE(known["parameters"][5]["known"]);
  EXPECT_EQ(known["parameters"][5]["value"], 0.2);
  Refuse("estimate scene.json", "bounds of a material");
}

TEST_F(MaterialsCommand, SaysWhichMaterialsItLeavesOut) {
  const auto write_scene = [&](const std::string& materials) {
    testing::WriteText(folder_ / "scene.json",
                       R"({"mesh": "block.vtu", "supports": [{"nodes":
             {"box": [[-1,-1,-1],[2,2,1e-9]]}}],
            "cases": [{"loads": [{"type": "nodal_force", "nodes": "free",
                                  "value": [0, 0, -1]}]}],
            "materials": )" +
                           materials + "}");
  };
  const std::string simulate =
      "simulate scene.json --youngs=1e4 --nu=0.3 --out=m.vtu --regions=";
  const char said[] = "scene.json: the laws, axes, known parameters and bounds";
  write_scene(R"([{"region": [1, 2, 3], "law": "transversely_isotropic",
                   "axis": [0, 0, 1]}])");
  EXPECT_THAT(Succeed(simulate + "each").errors, HasSubstr(said));
  EXPECT_THAT(Succeed(simulate + "one").errors, HasSubstr(said));
  write_scene(R"([{"region": 1, "known": {"poisson_ratio": 0.2}},
                  {"region": [2, 3]}])");
  EXPECT_THAT(Succeed(simulate + "each").errors, HasSubstr(said));
  write_scene(R"([{"region": [1, 2, 3]}])");
  EXPECT_THAT(Succeed(simulate + "each").errors, Not(HasSubstr(said)));
}

TEST_F(MaterialsCommand, RefusesWhatIsOfNoRegionOrNoMaterial) {
  Succeed(
      "simulate block.vtu --regions=each --parameters=truth.json --out=m.vtu");
  for (const auto& [material, why] :
       std::vector<std::pair<std::string, std::string>>{
           {R"("region": "1")",
            "region is \"1\", but the regions of the mesh have no names; give "
            "the id of a region, an integer"},
           {R"("region": 1.5)",
            "must be the id of a region, or its name, or a list of these"},
           {R"("region": 9223372036854775808)",
            "region must be an integer of at most 12 digits"},
           {R"("region": [1.0, 2, -1])",
            "material 1 names region -1, of which the mesh has no element; its "
            "regions are 1, 2, 3; correct the region"},
           {R"("region": [1, 2, 3], "law": "anisotropic",
               "known": {"c11": 100, "c22": 100, "c12": 200})",
            "material 1 gives c12 a value too far from zero"}}) {
    testing::WriteText(folder_ / "scene.json", R"({"mesh": "m.vtu",
        "materials": [{)" + material + R"(}],
        "supports": [{"nodes": {"box": [[-1,-1,-1],[2,2,1e-9]]}}],
        "cases": [{"displacement": {"array": "displacement"},
                   "loads": [{"type": "nodal_force", "array": "force"}]}]})");
    Refuse("estimate scene.json --estimator=reduced-fe --out=o.vtu", why);
  }
}

// A fit of all stiffnesses of many materials takes long.
TEST_F(MaterialsCommand, SaysHowManyStiffnessesAChoiceOfLawsFits) {
  Succeed("generate cuboid --cells=1,1,1 --out=cell.vtu");
  Succeed("simulate cell.vtu --youngs=1 --nu=0.3 --out=one.vtu");
  Refuse("estimate one.vtu --material=auto --estimator=iterative-fe",
         "--material=auto: laws are compared by a fit of all stiffnesses of "
         "all materials (21 parameters), but only 12 components were measured; "
         "name the law");
  const std::string materials =
      R"({"mesh": "m.vtu", "materials": [{"region": 1}, {"region": [2, 3]}],
          "supports": [{"nodes": {"box": [[-1,-1,-1],[2,2,1e-9]]}}],
          "cases": [{"displacement": {"array": "displacement"},
                     "loads": [{"type": "nodal_force", "array": "force"}]}]})";
  testing::WriteText(folder_ / "two.json", materials);
  Succeed("simulate block.vtu --youngs=1e4 --nu=0.3 --out=m.vtu");
  EXPECT_THAT(
      Run("estimate two.json --material=auto --estimator=reduced-fe").errors,
      HasSubstr("notice: --material=auto: laws are compared by a fit of all "
                "stiffnesses of all materials (42 parameters), which may take "
                "many minutes; "));
}

TEST_F(MaterialsCommand, NamesWhatIsWrong) {
  Succeed("generate cuboid --out=plain.vtu");
  Refuse("simulate plain.vtu --regions=each --youngs=1 --nu=0 --out=a.vtu",
         "plain.vtu: there are no regions");
  Refuse("simulate block.vtu --regions=two --youngs=1 --nu=0 --out=a.vtu",
         "--regions=two; it must be one, each or merge");
  Refuse("simulate block.vtu --parameters=truth.json --nu=0 --out=a.vtu",
         "give only one of them");
  Refuse("simulate block.vtu --parameters=truth.json --out=a.vtu",
         "truth.json: parameters[0] (youngs_modulus) names a region, but all "
         "regions share one material; give each its own by --regions=each");
  Refuse("plan plain.vtu --parameters=truth.json",
         "truth.json: parameters[0] (youngs_modulus) names a region, but the "
         "mesh has none; leave it out");
  testing::WriteText(
      folder_ / "plain.json",
      R"({"parameters": [{"name": "youngs_modulus_1", "value": 1}]})");
  Refuse("plan plain.vtu --parameters=plain.json",
         "parameters[0] (youngs_modulus_1) is no parameter of its material, "
         "which has youngs_modulus, poisson_ratio; correct the name");
}

TEST_F(MaterialsCommand, NamesTheParameterThatIsWrong) {
  for (const auto& [entry, says] : std::vector<std::pair<Json, std::string>>{
           {{{"name", "E"}, {"region", 1}, {"value", 1}},
            "parameters[0] (E) is no parameter of its material, which has "
            "youngs_modulus, poisson_ratio; correct the name"},
           {{{"name", "youngs_modulus"}, {"region", 9}, {"value", 1}},
            "is of region 9, but the materials of the scene are of region 1; "
            "of region 2; of region 3; correct the region"},
           {{{"name", "youngs_modulus"}, {"value", 1}},
            "names no region, but the materials of the scene are of region 1"},
           {{{"name", "youngs_modulus"}, {"region", "1"}, {"value", 1}},
            "parameters[0].region must be the id of a region, a list of ids, "
            "or null"}}) {
    testing::WriteText(folder_ / "one.json",
                       Json({{"parameters", Json::array({entry})}}).dump());
    Refuse(
        "simulate block.vtu --regions=each --parameters=one.json --out=a.vtu",
        says);
  }
  Json few = Parameters();
  few["parameters"].erase(5);
  testing::WriteText(folder_ / "few.json", few.dump());
  Refuse("simulate block.vtu --regions=each --parameters=few.json --out=a.vtu",
         "few.json: there is no value of poisson_ratio of region 3");
  Json wrong = Parameters();
  wrong["parameters"][1]["value"] = 0.5;
  testing::WriteText(folder_ / "wrong.json", wrong.dump());
  Refuse(
      "simulate block.vtu --regions=each --parameters=wrong.json --out=a.vtu",
      "wrong.json: parameters[1].value must be between -0.9999 and 0.49999");
  Json twice = Parameters();
  twice["parameters"].push_back(twice["parameters"][0]);
  testing::WriteText(folder_ / "twice.json", twice.dump());
  Refuse(
      "simulate block.vtu --regions=each --parameters=twice.json --out=a.vtu",
      "parameters[6] is a second value of youngs_modulus of region 1");
}

TEST_F(MaterialsCommand, NamesTheMaterialThatIsWrong) {
  for (
      const auto& [materials, says] :
      std::vector<std::pair<std::string, std::string>>{
          {R"([{"law": "rubber"}])",
           "materials[0].law is \"rubber\", which is no law; make it one of "
           "isotropic"},
          {R"([{"region": 1}])", "element"},
          {R"([{"region": [1, 2, 3], "known": {"E": 1}}])",
           "materials[0].known"},
          {R"([{"region": [1, 2, 3], "known": {"poisson_ratio": 0.5}}])",
           "poisson_ratio = 0.5"},
          {R"([{"region": [1, 2, 3], "bounds": {"poisson_ratio": [0.3, 0.1]}}])",
           "crossed"},
          {R"([{"prior": {"poisson_ratio": {"value": 0.3}}}])",
           "exactly one of the keys sd, relative_sd"},
          {R"([{"prior": {"nu": {"value": 0.3, "sd": 1}}}])",
           "materials[0].prior"},
          {R"([{"region": 1e10}])", "materials[0].region"},
          {"[]", "materials is empty"}}) {
    testing::WriteText(
        folder_ / "scene.json",
        R"({"mesh": "block.vtu", "supports": [{"nodes": {"ids": [0, 1, 2, 3]}}],
            "cases": [{"loads": []}], "materials": )" +
            materials + "}");
    Refuse("simulate scene.json --youngs=1 --nu=0 --out=a.vtu", says);
  }
}

}  // namespace
}  // namespace elastimate
