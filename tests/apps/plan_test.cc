// Tests of the command plan.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <nlohmann/json.hpp>
#include <set>
#include <string>

#include "tests/apps/region_scene.h"
#include "tests/program.h"

namespace elastimate {
namespace {

using Json = nlohmann::json;
using ::testing::HasSubstr;
using ::testing::Not;

class PlanCommand : public testing::ProgramTest {
 protected:
  void SetUp() override {
    testing::ProgramTest::SetUp();
    Succeed("generate cuboid --out=cuboid.vtu");
  }

  // Writes a scene.json with a bar of 4 x 1 x 1 on rollers and these `cases`.
  void WriteBar(const Json& cases) {
    Succeed(
        "generate cuboid --elements=hex8 --cells=4,2,2 --size=4,1,1 "
        "--out=bar.vtu");
    const auto plane = [](int axis) {
      Json low = {-1, -1, -1};
      Json high = {9, 9, 9};
      low[axis] = high[axis] = 0;
      return Json({{"box", {low, high}}});
    };
    const Json scene = {{"mesh", "bar.vtu"},
                        {"supports",
                         {{{"nodes", plane(0)}, {"components", "x"}},
                          {{"nodes", plane(1)}, {"components", "y"}},
                          {{"nodes", plane(2)}, {"components", "z"}}}},
                        {"cases", cases}};
    testing::WriteText(folder_ / "bar.json", scene.dump());
  }

  // Selects the nodes at y = z = 0, whose x component the rollers leave free.
  static Json Edge() { return {{"box", {{-1, 0, 0}, {9, 0, 0}}}}; }

  static Json Pull(int axis) {
    Json low = {-1, -1, -1};
    Json high = {9, 9, 9};
    low[axis] = high[axis] = axis == 0 ? 4 : 1;
    Json force = {0, 0, 0};
    force[axis] = 100;
    return {{"type", "force"},
            {"value", force},
            {"surface", {{"box", {low, high}}}}};
  }

  static std::set<std::string> NamesOf(const Json& plan) {
    std::set<std::string> names;
    for (const Json& candidate : plan["candidates"]) {
      names.insert(candidate["name"]);
    }
    return names;
  }
};

TEST_F(PlanCommand, ComparesUnitLoadsOnTheLoadedSurface) {
  const Json plan = Succeed("plan cuboid.vtu --json=-").Json();
  EXPECT_EQ(NamesOf(plan),
            std::set<std::string>({"force along x", "force along y",
                                   "force along z", "moment about x",
                                   "moment about y", "moment about z"}));
  EXPECT_EQ(plan["parameters_from"], "typical");
  EXPECT_EQ(plan["relative_noise"], 0.01);
  EXPECT_TRUE(plan["noise_sd"].is_null());
  EXPECT_EQ(plan["before"]["load_cases"], Json({1}));
  EXPECT_FALSE(plan["before"]["measured"]);
  double last = 0;
  for (const Json& candidate : plan["candidates"]) {
    // A candidate has no size where the scene gives none.
    EXPECT_TRUE(candidate["size"].is_null());
    const double error = candidate["worst_combination"]["standard_error"];
    EXPECT_GE(error, (1 - 1e-5) * last);  // Alike but for rounding.
    EXPECT_LT(error, plan["before"]["worst_combination"]["standard_error"]);
    last = error;
  }
  EXPECT_EQ(plan["sequence"][0], plan["candidates"][0]);
  const testing::ProgramRun table = Succeed("plan cuboid.vtu");
  EXPECT_THAT(table.output,
              HasSubstr("measure next          " +
                        plan["sequence"][0]["name"].get<std::string>() + "\n"));
}

TEST_F(PlanCommand, ComparesLoadCasesWithoutDisplacement) {
  WriteBar({{{"loads", {Pull(0)}}, {"observed", Edge()}},
            {{"loads", {Pull(0)}}, {"observed", Edge()}},
            {{"loads", {Pull(1)}}}});
  const Json plan = Succeed("plan bar.json --json=-").Json();
  EXPECT_EQ(NamesOf(plan),
            std::set<std::string>({"load case 2", "load case 3"}));
  EXPECT_TRUE(plan["before"]["standard_errors"][1].is_null());
  EXPECT_FALSE(plan["before"]["determined"]);
  EXPECT_EQ(plan["before"]["undetermined_combinations"], 1);
  EXPECT_EQ(plan["before"]["worst_combination"]["text"], "nu");
  EXPECT_EQ(plan["candidates"][0]["load_case"], 3);
  EXPECT_TRUE(plan["candidates"][0]["determined"]);
  EXPECT_FALSE(plan["candidates"][1]["determined"]);
  EXPECT_THAT(Succeed("plan bar.json").output, HasSubstr("undetermined: nu"));
  // With a surface, unit loads on it are candidates as well.
  EXPECT_EQ(
      NamesOf(Succeed("plan bar.json --surface=4,0,0,4,1,1 --json=-").Json())
          .size(),
      8U);
}

TEST_F(PlanCommand, SaysWhereNoLoadHelps) {
  WriteBar({{{"loads", {Pull(0)}}, {"observed", Edge()}},
            {{"loads", {Pull(0)}}, {"observed", Edge()}}});
  const testing::ProgramRun run = Run("plan bar.json");
  EXPECT_EQ(run.exit_code, 1);
  EXPECT_THAT(run.output, HasSubstr("NOT DETERMINED"));
  EXPECT_EQ(run.errors, "");
}

TEST_F(PlanCommand, TakesParametersAndNoiseOfAMeasurement) {
  Succeed(
      "simulate cuboid.vtu --youngs=50000 --nu=0.3 --noise=0.02 "
      "--noise_law=gaussian --out=measured.vtu");
  const Json plan = Succeed("plan measured.vtu --json=plan.json").output.empty()
                        ? Json()
                        : Json::parse(testing::ReadText(folder_ / "plan.json"));
  const Json estimate =
      Succeed("estimate measured.vtu --estimator=iterative-fe --json=-").Json();
  EXPECT_EQ(plan["parameters_from"], "estimate");
  EXPECT_TRUE(plan["before"]["measured"]);
  EXPECT_NEAR(plan["parameters"][0]["value"].get<double>() /
                  estimate["youngs_modulus"].get<double>(),
              1, 1e-9);
  EXPECT_NEAR(
      plan["noise_sd"].get<double>() / estimate["noise_sd"].get<double>(), 1,
      1e-9);
  EXPECT_GT(plan["candidates"][0]["size"].get<double>(), 0);
  // Before a further load, the plan expects the noise errors of the estimate.
  EXPECT_NEAR(
      plan["before"]["standard_errors"][1].get<double>() /
          estimate["error_budget"]["noise"]["poisson_ratio"].get<double>(),
      1, 0.05);
  // Twice the noise makes twice the errors.
  const std::string noise =
      std::to_string(2e6 * plan["noise_sd"].get<double>());
  const Json twice =
      Succeed("plan measured.vtu --json=- --noise_sd=" + noise + "e-6").Json();
  EXPECT_NEAR(twice["before"]["standard_errors"][0].get<double>() /
                  plan["before"]["standard_errors"][0].get<double>(),
              2, 1e-3);
}

// A block of 2 cells is a coarse mesh, whose error is larger than that of
// noise.
TEST_F(PlanCommand, SaysWhatTheEstimateHasBesideNoise) {
  Succeed("generate cuboid --cells=2,2,2 --out=coarse.vtu");
  Succeed(
      "simulate coarse.vtu --youngs=50000 --nu=0.4 --order=2 --noise=0.01 "
      "--out=coarse_measured.vtu");
  const Json plan = Succeed("plan coarse_measured.vtu --json=-").Json();
  const Json estimate =
      Succeed("estimate coarse_measured.vtu --estimator=iterative-fe --json=-")
          .Json();
  const double of_all =
      plan["before"]["standard_errors_of_estimate"][0].get<double>();
  EXPECT_NEAR(of_all * estimate["youngs_modulus"].get<double>() /
                  estimate["standard_error"]["youngs_modulus"].get<double>(),
              1, 1e-9);
  EXPECT_GT(of_all, plan["before"]["standard_errors"][0].get<double>());
  EXPECT_THAT(Succeed("plan coarse_measured.vtu").output,
              HasSubstr("before, all errors    "));
  const testing::ProgramRun unmeasured = Succeed("plan coarse.vtu");
  EXPECT_THAT(unmeasured.output, HasSubstr("those of noise; an estimate also"));
  EXPECT_THAT(unmeasured.output, Not(HasSubstr("all errors")));
}

TEST_F(PlanCommand, GivenNoiseOfGivenParametersIsALength) {
  const auto error = [&](const std::string& flags) {
    return Succeed("plan cuboid.vtu --json=- " + flags)
        .Json()["candidates"][0]["standard_errors"][0]
        .get<double>();
  };
  const double soft = error("--youngs=1e4 --nu=0.3 --noise_sd=1e-4");
  // A stiff specimen moves less under the given load.
  EXPECT_NEAR(error("--youngs=1e5 --nu=0.3 --noise_sd=1e-4") / soft, 10, 1e-6);
  const double relative = error("--youngs=1e4 --nu=0.3 --noise=0.01");
  EXPECT_NEAR(error("--youngs=1e5 --nu=0.3 --noise=0.01") / relative, 1, 1e-6);
  // With typical parameters, nothing tells how much the specimen moves.
  const testing::ProgramRun run =
      Succeed("plan cuboid.vtu --json=- --noise_sd=1e-4");
  EXPECT_TRUE(run.Json()["noise_sd"].is_null());
  EXPECT_THAT(run.errors, HasSubstr("notice: the standard deviation"));
}

TEST_F(PlanCommand, TakesRegionsAndQuadraticElements) {
  testing::WriteRegions(folder_ / "block.vtu");
  const Json plan =
      Succeed("plan block.vtu --regions=each --order=2 --json=-").Json();
  ASSERT_EQ(plan["parameters"].size(), 6U);
  EXPECT_EQ(plan["parameters"][5]["name"], "poisson_ratio");
  EXPECT_EQ(plan["parameters"][5]["region"], 3);
  EXPECT_EQ(plan["before"]["standard_errors"].size(), 6U);
  EXPECT_THAT(Succeed("plan block.vtu --regions=each").output,
              HasSubstr("nu of region 2"));
}

TEST_F(PlanCommand, TakesPlanarScenes) {
  Succeed("generate plate --cells=6 --out=plate.vtu");
  EXPECT_EQ(
      NamesOf(Succeed("plan plate.vtu --json=-").Json()),
      std::set<std::string>({"force along x", "force along y", "moment"}));
  // In the plane, a box has four numbers.
  EXPECT_EQ(
      NamesOf(Succeed("plan plate.vtu --surface=10,0,10,10 --json=-").Json())
          .size(),
      3U);
  Refuse("plan plate.vtu --surface=10,0,0,10,10,0", "four finite numbers");
}

TEST_F(PlanCommand, RefusesWrongInput) {
  Refuse("plan", "needs one scene");
  Refuse("plan cuboid.vtu cuboid.vtu", "needs one scene");
  Refuse("plan none.vtu", "none.vtu");
  Refuse("plan cuboid.vtu --youngs=5", "--nu");
  Refuse("plan cuboid.vtu --youngs=-5 --nu=0.3", "--youngs=-5");
  Refuse("plan cuboid.vtu --regions=merge", "one or each");
  Refuse("plan cuboid.vtu --noise=0", "--noise=0");
  Refuse("plan cuboid.vtu --noise_sd=-1", "--noise_sd=-1");
  Refuse("plan cuboid.vtu --noise_sd=1 --noise=1", "only one of them");
  Refuse("plan cuboid.vtu --surface=1,2,3", "six finite numbers");
  Refuse("plan cuboid.vtu --surface=5,5,5,6,6,6", "no face of the surface");
  Refuse("plan cuboid.vtu --json=cuboid.vtu", "cuboid.vtu");
  Refuse("plan cuboid.vtu --estimator=auto", "--estimator");
  WriteBar({{{"loads", Json::array()}}});
  Refuse("plan bar.json --surface=4,0,0,4,1,1", "bar.json: all loads are zero");
  // The scene has held ends that move, and no load on a surface.
  Succeed("generate plate --cells=6 --ends=grips --out=grips.vtu");
  Refuse("plan grips.vtu", "--surface");
}

}  // namespace
}  // namespace elastimate
