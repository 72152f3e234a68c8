// Supports that end within quadratic elements.

#include <gtest/gtest.h>

#include <cmath>

#include "elastimate/core/scene/quadratic_scene.h"
#include "elastimate/estimators/registry.h"
#include "tests/scenes.h"

namespace elastimate {
namespace {

// A bar that a clamp holds from x = 0 to beyond the middle of the edges around
// its end, pulled askew, and measured at the vertices of quadratic elements.
class ClampedBar : public ::testing::Test {
 protected:
  static constexpr double kClampedModulus = 12000;
  static constexpr double kClampedRatio = 0.45;

  ClampedBar() {
    scene_.mesh = testing::Distorted(testing::BoxMesh({8, 4, 4}, {2, 1, 1}));
    const Eigen::Index num_nodes = scene_.mesh.NumNodes();
    const HeldBox clamp = {
        Eigen::Vector3d(-1, -1, -1), Eigen::Vector3d(0.68, 2, 2),
        Eigen::Array3<bool>::Constant(true), Eigen::Vector3d::Zero()};
    scene_.supports = {ComponentMask::Constant(3, num_nodes, false),
                       Eigen::MatrixXd::Zero(3, num_nodes),
                       {clamp}};
    for (Eigen::Index node = 0; node < num_nodes; ++node) {
      scene_.supports.held.col(node).setConstant(scene_.mesh.nodes(0, node) <=
                                                 0.68);
    }
    LoadCase load_case;
    load_case.loads = {BodyForce{Eigen::Vector3d(20, -5, -3)}};
    scene_.load_cases = {load_case};
    Scene specimen = QuadraticScene(scene_);
    testing::Measure({kClampedModulus, kClampedRatio}, specimen);
    scene_.load_cases[0].displacement =
        specimen.load_cases[0].displacement.leftCols(num_nodes);
  }

  Scene scene_;
};

TEST_F(ClampedBar, IsExactWhereTheClampIsABox) {
  const Estimate estimate =
      MakeEstimator("reduced-fe")->Run(QuadraticScene(scene_), {});
  EXPECT_EQ(estimate.status, Status::kOk) << estimate.message;
  EXPECT_NEAR(estimate.elasticity.youngs_modulus / kClampedModulus, 1, 1e-6);
  EXPECT_NEAR(estimate.elasticity.poisson_ratio, kClampedRatio, 1e-6);
}

TEST_F(ClampedBar, IsSofterWhereTheClampEndsWithItsVertices) {
  scene_.supports.boxes.clear();
  const Estimate estimate =
      MakeEstimator("reduced-fe")->Run(QuadraticScene(scene_), {});
  EXPECT_GT(estimate.elasticity.youngs_modulus / kClampedModulus, 1.01);
}

}  // namespace
}  // namespace elastimate
