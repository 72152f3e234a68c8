// What the reports of a series say where its frames determine the shear modulus
// alone.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "elastimate/core/scene/scene.h"
#include "elastimate/io/report/html_report.h"
#include "elastimate/io/report/report.h"
#include "elastimate/io/report/series_table.h"
#include "elastimate/io/report/summary.h"
#include "tests/scenes.h"

namespace elastimate {
namespace {

using nlohmann::json;
using ::testing::HasSubstr;
using ::testing::Not;

Estimate EstimateOfElasticity(double youngs_modulus, double poisson_ratio) {
  Estimate estimate;
  estimate.Accept();
  estimate.findings.clear();
  estimate.elasticity = {youngs_modulus, poisson_ratio};
  ParameterEstimate youngs;
  youngs.name = "youngs_modulus";
  youngs.symbol = "E";
  youngs.is_modulus = true;
  youngs.value = youngs_modulus;
  youngs.standard_error = 60;
  ParameterEstimate poisson;
  poisson.name = "poisson_ratio";
  poisson.symbol = "nu";
  poisson.value = poisson_ratio;
  poisson.standard_error = 0.25;
  estimate.parameters = {youngs, poisson};
  estimate.covariance = Eigen::Vector2d(3600, 0.0625).asDiagonal();
  estimate.parameter_covariance = estimate.covariance;
  return estimate;
}

// Has a frame that determines the shear modulus alone, one whose mu follows
// from E and nu, and one that failed.
class SeriesOfShearModulus : public ::testing::Test {
 protected:
  SeriesOfShearModulus() {
    series_.files = {"a.csv", "b.csv", "c.csv"};
    series_.loads = {1, 2, 4};
    frames_.resize(3);
    frames_[0].estimate = EstimateOfElasticity(90, 0.4);
    frames_[0].estimate.shear_modulus = ModulusEstimate{32, 0.5};
    // The errors of mu = 50 by E and by nu are 60 / 2 and 0.25 * 100 / 2.
    frames_[1].estimate = EstimateOfElasticity(100, 0);
    frames_[2].estimate.Fail(
        {FindingCode::kNotRun, Severity::kError, "it was not run", "run it"});
    joint_ = EstimateOfElasticity(90, 0.4);
    joint_.shear_modulus = ModulusEstimate{33, 0.25};
    joint_.series = SeriesSummary{3, 2, {1, 4}, std::nullopt};
    const auto of_shear_modulus = [](double value) {
      return Eigen::Vector3d(Estimate::kUnknown, Estimate::kUnknown, value);
    };
    joint_.series->trend =
        Trend{true, of_shear_modulus(-0.25), of_shear_modulus(0.015625),
              of_shear_modulus(0.5)};
    const Mesh mesh = testing::BoxMesh({1, 1, 1}, {1, 1, 1});
    scene_ = testing::HeldAtBottom(mesh, mesh, {0, 0, -1});
  }

  FrameSeries series_;
  std::vector<FrameEstimate> frames_;
  Estimate joint_;
  Scene scene_;
};

TEST_F(SeriesOfShearModulus, HasColumnsOfItInTheTable) {
  EXPECT_EQ(SeriesTable(series_, frames_, joint_),
            "frame,file,load,status,youngs_modulus,"
            "youngs_modulus_standard_error,poisson_ratio,"
            "poisson_ratio_standard_error,shear_modulus,"
            "shear_modulus_standard_error,noise_sd,outliers,findings,reason\n"
            "1,a.csv,1.0,ok,90.0,60.0,0.4,0.25,32.0,0.5,,0,,\n"
            "2,b.csv,2.0,ok,100.0,60.0,0.0,0.25,50.0,32.5,,0,,\n"
            "3,c.csv,4.0,not_run,,,,,,,,0,not_run,\"it was not run; run "
            "it\"\n"
            "joint,,,ok,90.0,60.0,0.4,0.25,33.0,0.25,,0,,\n");
}

TEST_F(SeriesOfShearModulus, HasNoColumnsOfItWhereNoneIsDetermined) {
  frames_[0].estimate.shear_modulus.reset();
  joint_.shear_modulus.reset();
  EXPECT_THAT(SeriesTable(series_, frames_, joint_),
              Not(HasSubstr("shear_modulus")));
}

TEST_F(SeriesOfShearModulus, TellsItsChangeInTheReport) {
  const json report = json::parse(JsonReport(joint_, scene_, {}, {0, 0}));
  EXPECT_EQ(report["shear_modulus"], 33);
  EXPECT_EQ(report["standard_error"]["shear_modulus"], 0.25);
  const json& series = report["series"];
  EXPECT_EQ(series["changes_over"], "load");
  ASSERT_EQ(series["changes"].size(), 3U);
  EXPECT_TRUE(series["changes"][0]["change"].is_null());
  EXPECT_TRUE(series["changes"][1]["change"].is_null());
  const json& change = series["changes"][2];
  EXPECT_EQ(change["name"], "shear_modulus");
  EXPECT_EQ(change["change"], -0.25);
  EXPECT_EQ(change["standard_error"], 0.015625);
  EXPECT_EQ(change["p_value"], 0.5);
}

TEST_F(SeriesOfShearModulus, IsInTheSummary) {
  const std::string summary = Summary(joint_, scene_, {0, 0});
  EXPECT_THAT(summary, HasSubstr("33.00 +- 0.25"));
  EXPECT_THAT(summary, HasSubstr("mu -25 +- 1.6 %"));
  EXPECT_THAT(summary, Not(HasSubstr("nan")));
}

TEST_F(SeriesOfShearModulus, IsInTheDataOfThePage) {
  PageTexts texts;
  texts.title = "torsion";
  texts.report = JsonReport(joint_, scene_, {}, {0, 0});
  texts.frames = SeriesTable(series_, frames_, joint_);
  const json data = json::parse(
      HtmlReport("<!--data-->", scene_, joint_, SceneResults(), texts));
  EXPECT_EQ(data["shear_modulus"],
            json({{"value", 33}, {"standard_error", 0.25}}));
  EXPECT_EQ(data["frames"], texts.frames);
  joint_.shear_modulus.reset();
  EXPECT_TRUE(json::parse(HtmlReport("<!--data-->", scene_, joint_,
                                     SceneResults(), texts))["shear_modulus"]
                  .is_null());
}

}  // namespace
}  // namespace elastimate
