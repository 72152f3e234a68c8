// The fields that `estimate --out` writes for planar scenes, whose fits end at
// finer elements than the mesh has.

#include <gtest/gtest.h>

#include <iomanip>
#include <sstream>
#include <string>

#include "elastimate/core/scene/scene.h"
#include "elastimate/io/scene/mesh_reader.h"
#include "tests/program.h"

namespace elastimate {
namespace {

// A strip of 6 x 2 x 0.5 under the uniaxial stress 3, with E = 2000 and
// nu = 0.25, so that displacements are linear and every element kind is exact.
class ResultFieldsOfPlanes : public testing::ProgramTest {
 protected:
  void SetUp() override {
    testing::ProgramTest::SetUp();
    WritePoints(0);
  }

  // Measures with a camera that has moved to the left.
  void WritePoints(double shift) const {
    std::ostringstream text;
    text << std::setprecision(17) << "x,y,ux,uy\n";
    for (int i = 0; i <= 12; ++i) {
      for (int j = 0; j <= 4; ++j) {
        text << 0.5 * i << "," << 0.5 * j << "," << shift + 1.5e-3 * 0.5 * i
             << "," << -0.25 * 1.5e-3 * 0.5 * j << "\n";
      }
    }
    testing::WriteText(folder_ / "points.csv", text.str());
  }

  MeshFile FieldsOf(const std::string& supports, const std::string& load,
                    const std::string& more = "") const {
    testing::WriteText(folder_ / "scene.json", "{" + more + R"(
      "model": "plane_stress", "thickness": 0.5,
      "mesh": {"points": "points.csv", "margin": 0},
      "supports": [)" + supports + R"(],
      "cases": [ {"loads": [ )" + load + R"(, "surface":
        {"box": [[6, 0], [6, 2]]}} ]} ] })");
    Succeed("estimate scene.json --estimator=iterative-fe --out=fields.vtu");
    return ReadMeshFile(folder_ / "fields.vtu");
  }

  static void ExpectTruth(const MeshFile& fields) {
    const Eigen::MatrixXd* const energy =
        FindArray(fields.element_arrays, "strain_energy_density");
    ASSERT_NE(energy, nullptr);
    ASSERT_EQ(energy->cols(), 48);
    EXPECT_LT((energy->array() / (9. / 4000) - 1).abs().maxCoeff(), 1e-6);
    const Eigen::MatrixXd* const fitted =
        FindArray(fields.node_arrays, "fitted_displacement");
    ASSERT_NE(fitted, nullptr);
    EXPECT_LT((fitted->row(0) - 1.5e-3 * fields.nodes.row(0)).norm(), 1e-7);
    const Eigen::MatrixXd* const residual =
        FindArray(fields.node_arrays, "displacement_residual");
    ASSERT_NE(residual, nullptr);
    EXPECT_LT(residual->norm(), 1e-7);
    const Eigen::MatrixXd* const reaction =
        FindArray(fields.node_arrays, "reaction_force");
    ASSERT_NE(reaction, nullptr);
    const auto is_left = (fields.nodes.row(0).array() == 0).cast<double>();
    EXPECT_NEAR((reaction->row(0).array() * is_left).sum(), -3, 1e-6);
  }
};

TEST_F(ResultFieldsOfPlanes, AreRightForSupportsThatMovedAsMeasured) {
  ExpectTruth(FieldsOf(
      R"({"nodes": {"box": [[0, 0], [0, 2]]}, "displacement": "measured"},
         {"nodes": {"box": [[6, 0], [6, 2]]}, "displacement": "measured"})",
      R"({"type": "resultant", "value": [3, null], "sd": 0.01)"));
}

TEST_F(ResultFieldsOfPlanes, AreRightForSupportsThatDidNotMove) {
  ExpectTruth(FieldsOf(
      R"({"nodes": {"box": [[0, 0], [0, 2]]}, "components": "x"},
         {"nodes": {"box": [[0, 0], [0, 0]]}, "components": "y"})",
      R"({"type": "force", "value": [3, 0])"));
}

// The box says that its nodes stayed where they were, but the camera moved.
TEST_F(ResultFieldsOfPlanes, AreRightForACameraThatMoved) {
  WritePoints(5);
  const MeshFile fields = FieldsOf(
      R"({"nodes": {"box": [[0, 0], [0, 2]]}, "components": "xy"})",
      R"({"type": "force", "value": [3, 0])", R"("rigid_motion": "free",)");
  const Eigen::MatrixXd& residual =
      *FindArray(fields.node_arrays, "displacement_residual");
  EXPECT_LT(residual.norm(), 0.01);
  const Eigen::MatrixXd& reaction =
      *FindArray(fields.node_arrays, "reaction_force");
  EXPECT_NEAR(reaction.row(0).sum(), -3, 1e-6);
  EXPECT_LT(reaction.cwiseAbs().maxCoeff(), 3);
}

class ResultFieldsOfLargeStrains : public testing::ProgramTest {};

TEST_F(ResultFieldsOfLargeStrains, AreInEquilibriumWithTheLoads) {
  Succeed(
      "generate cuboid --elements=hex8 --cells=2,2,3 --size=1,1,2 "
      "--force=0.4,0,-1 --out=cuboid.vtu");
  Succeed(
      "simulate cuboid.vtu --material=neo_hookean --youngs=500 --nu=0.3 "
      "--out=measured.vtu");
  Succeed(
      "estimate measured.vtu --material=neo_hookean "
      "--estimator=iterative-fe --out=fields.vtu");
  const MeshFile fields = ReadMeshFile(folder_ / "fields.vtu");
  const auto array = [&](const std::string& name) {
    const Eigen::MatrixXd* const values = FindArray(fields.node_arrays, name);
    EXPECT_NE(values, nullptr) << name;
    return values != nullptr ? *values : Eigen::MatrixXd();
  };
  const Eigen::MatrixXd measured = array("displacement");
  EXPECT_GT(measured.cwiseAbs().maxCoeff(), 0.05);
  EXPECT_LT((array("fitted_displacement") - measured).norm(),
            1e-6 * measured.norm());
  EXPECT_LT(array("displacement_residual").norm(), 1e-6 * measured.norm());
  const Eigen::VectorXd load = array("force").rowwise().sum();
  EXPECT_LT((array("reaction_force").rowwise().sum() + load).norm(),
            1e-6 * load.norm());
}

}  // namespace
}  // namespace elastimate
