// Tests of the command validate.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <nlohmann/json.hpp>
#include <string>

#include "tests/program.h"

namespace elastimate {
namespace {

using ::testing::HasSubstr;

class ValidateCommand : public testing::ProgramTest {
 protected:
  void SetUp() override {
    testing::ProgramTest::SetUp();
    std::filesystem::copy(ELASTIMATE_SOURCE "/examples/three_regions", folder_);
  }
};

TEST_F(ValidateCommand, ComparesModelsByWhatTheyHaveNotSeen) {
  const testing::ProgramRun run = Succeed(
      "validate scene.json --noise_sd=3.2e-7 --compare=one_material "
      "--folds=3 --json=v.json --out=v.vtu");
  EXPECT_THAT(run.output, HasSubstr("the model predicts what it has not seen: "
                                    "its errors are "));
  EXPECT_TRUE(std::filesystem::exists(folder_ / "v.vtu"));
  const nlohmann::json json =
      nlohmann::json::parse(testing::ReadText(folder_ / "v.json"));
  ASSERT_EQ(json["models"].size(), 2);
  const nlohmann::json& each = json["models"][0];
  const nlohmann::json& one = json["models"][1];
  EXPECT_EQ(each["folds"].size(), 3);
  EXPECT_FALSE(each["is_off"]);
  EXPECT_TRUE(one["is_off"]);
  EXPECT_GT(one["relative_error"], 20 * each["relative_error"].get<double>());
}

TEST_F(ValidateCommand, EndsWithOneWhereThePredictionIsOff) {
  const testing::ProgramRun run =
      Run("validate scene.json --regions=one --noise_sd=3.2e-7 --folds=3");
  EXPECT_EQ(run.exit_code, 1) << run.errors;
  EXPECT_THAT(run.output, HasSubstr("PREDICTION IS OFF"));
  EXPECT_THAT(run.output, HasSubstr("2 other parts are refused as well"));
}

TEST_F(ValidateCommand, RefusesWrongFlags) {
  Refuse("validate", "validate needs a scene file");
  Refuse("validate scene.json --folds=1 --out=v.vtu", "--folds=1");
  Refuse("validate scene.json --folds=1000",
         "points, which cannot be divided into 1000 parts; give --folds=N of "
         "at most ");
  Refuse("validate scene.json --compare=linear,linear",
         "names linear twice; name each model once");
  Refuse("validate scene.json --hold_out=frames", "points or load_cases");
  Refuse("validate scene.json --hold_out=load_cases", "one load case");
  Refuse("validate scene.json --compare=rubber", "rubber is no model");
  Refuse("validate scene.json --compare=orthotropic --json=v.json",
         "as orthotropic: material 1 (orthotropic) has no axes");
  Refuse("validate scene.json --regions=merge", "--regions=merge");
  Refuse("validate scene.json --material=auto", "--compare=LAW");
}

}  // namespace
}  // namespace elastimate
