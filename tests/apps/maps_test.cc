// Maps of a modulus as a user of the program asks for them.

#include <gtest/gtest.h>

#include <cmath>
#include <string>

#include "elastimate/core/scene/scene.h"
#include "elastimate/io/scene/mesh_reader.h"
#include "tests/apps/region_scene.h"
#include "tests/program.h"

namespace elastimate {
namespace {

// A bar whose middle is five times as stiff as its ends, measured with
// noise.
class MapsOfBars : public testing::ProgramTest {
 protected:
  void SetUp() override {
    testing::ProgramTest::SetUp();
    testing::WriteRegions(folder_ / "bar.vtu");
    testing::WriteText(folder_ / "parameters.json", R"({"parameters": [
      {"name": "youngs_modulus", "region": 1, "value": 1e4},
      {"name": "poisson_ratio", "region": 1, "value": 0.3},
      {"name": "youngs_modulus", "region": 2, "value": 5e4},
      {"name": "poisson_ratio", "region": 2, "value": 0.3},
      {"name": "youngs_modulus", "region": 3, "value": 1e4},
      {"name": "poisson_ratio", "region": 3, "value": 0.3}]})");
    Succeed(
        "simulate bar.vtu --regions=each --parameters=parameters.json "
        "--noise=0.005 "
        "--noise_law=gaussian --out=measured.vtu");
  }
};

TEST_F(MapsOfBars, ShowTheStiffPart) {
  const auto report =
      Succeed(
          "estimate measured.vtu --estimator=auto --map=youngs_modulus "
          "--json=- --out=map.vtu")
          .Json();
  EXPECT_NE(report["map"]["verdict"], "homogeneous");
  EXPECT_GT(report["map"]["supported_parameters"].get<double>(), 1);
  const MeshFile map = ReadMeshFile(folder_ / "map.vtu");
  for (const char* const name : {"youngs_modulus", "resolution_length",
                                 "youngs_modulus_standard_error"}) {
    EXPECT_NE(FindArray(map.element_arrays, name), nullptr) << name;
  }
  const Eigen::MatrixXd& moduli =
      *FindArray(map.element_arrays, "youngs_modulus");
  const Eigen::MatrixXd& regions = *FindArray(map.element_arrays, "region");
  double of_middle = 0;
  double of_ends = 0;
  for (Eigen::Index e = 0; e < moduli.cols(); ++e) {
    (regions(e) == 2 ? of_middle : of_ends) += std::log(moduli(e));
  }
  const double num_middle = double((regions.array() == 2).count());
  EXPECT_GT(of_middle / num_middle,
            of_ends / (double(moduli.cols()) - num_middle) + std::log(2.5));
}

// The residual of the report is that of the fit, and those of the file are
// solved for anew.
TEST_F(MapsOfBars, WriteWhatWasFitted) {
  std::string parameters = testing::ReadText(folder_ / "parameters.json");
  for (std::size_t i; (i = parameters.find("e4")) != std::string::npos;) {
    parameters.replace(i, 2, "e6");
  }
  testing::WriteText(folder_ / "stiff.json", parameters);
  Succeed(
      "simulate bar.vtu --regions=each --parameters=stiff.json --noise=0.005 "
      "--noise_law=gaussian --out=measured.vtu");
  const auto run = Succeed(
      "estimate measured.vtu --estimator=auto --map=youngs_modulus "
      "--origin=measured --nu=0.3 --json=report.json --out=map.vtu");
  EXPECT_NE(run.output.find("0.3 (known)"), std::string::npos) << run.output;
  EXPECT_NE(run.output.find("geometric mean of E"), std::string::npos);
  EXPECT_EQ(run.errors.find("--regions=each"), std::string::npos) << run.errors;
  const auto report =
      nlohmann::json::parse(testing::ReadText(folder_ / "report.json"));
  EXPECT_EQ(report["mesh"]["order"], 2);
  EXPECT_GT(report["error_budget"]["discretization"]["youngs_modulus"], 0);
  const double relative = report["residual"]["displacement_relative"];
  const MeshFile map = ReadMeshFile(folder_ / "map.vtu");
  const Eigen::MatrixXd* const residual =
      FindArray(map.node_arrays, "displacement_residual");
  const Eigen::MatrixXd* const measured =
      FindArray(map.node_arrays, "displacement");
  ASSERT_NE(residual, nullptr);
  ASSERT_NE(measured, nullptr);
  EXPECT_NEAR(residual->norm() / measured->norm() / relative, 1, 1e-6);
}

TEST_F(MapsOfBars, TakeEachElementByItselfWithClosedForm) {
  Succeed("generate cuboid --elements=hex8 --cells=4,4,4 --out=block.vtu");
  Succeed("simulate block.vtu --youngs=1e4 --nu=0.3 --out=exact.vtu");
  const auto report = Succeed(
                          "estimate exact.vtu --estimator=closed-form "
                          "--map=youngs_modulus --json=- --out=map.vtu")
                          .Json();
  EXPECT_EQ(report["map"]["verdict"], "elements");
  EXPECT_TRUE(report["map"]["log_evidence"]["field"].is_null());
  EXPECT_NE(report["findings"].dump().find("local_map"), std::string::npos);
  const MeshFile map = ReadMeshFile(folder_ / "map.vtu");
  const Eigen::MatrixXd* const moduli =
      FindArray(map.element_arrays, "youngs_modulus");
  ASSERT_NE(moduli, nullptr);
  EXPECT_LT((moduli->array() / 1e4 - 1).abs().maxCoeff(), 1e-6);
}

TEST_F(MapsOfBars, RefuseWhatTheyDoNotTake) {
  const std::string map = "estimate measured.vtu --map=youngs_modulus ";
  Refuse("estimate measured.vtu --estimator=auto --map=nu",
         "--map=nu; it must be youngs_modulus");
  Refuse(map + "--estimator=reduced-fe", "it estimates no map of a modulus");
  Refuse(map + "--estimator=auto --material=auto",
         "--map is for one isotropic material");
  Refuse(map + "--estimator=auto --regions=merge", "leave out --regions=merge");
  Refuse(map + "--estimator=auto --material=orthotropic",
         "leave out --material=orthotropic");
  Refuse(map + "--estimator=iterative-fe --kinematics=large",
         "a map is of small strains");
  Refuse(map + "--estimator=iterative-fe --nu_min=0.1",
         "a map keeps no bounds");
}

}  // namespace
}  // namespace elastimate
