#include "elastimate/estimators/force_balance/held_scene.h"

#include <gtest/gtest.h>

#include "elastimate/core/equilibrium/forward_model.h"
#include "elastimate/core/scene/loads.h"
#include "elastimate/core/scene/rigid_motion.h"
#include "tests/dense_reference.h"
#include "tests/regions.h"
#include "tests/scenes.h"

namespace elastimate {
namespace {

TEST(HeldScene, KeepsWhatIsHeld) {
  const Scene scene = testing::BlockUnderTraction({2, 2, 2}, {1, 1, 1});
  const Scene held = HeldScene(scene);
  EXPECT_TRUE((held.supports.held == scene.supports.held).all());
  EXPECT_FALSE(held.is_rigid_motion_free);
}

// As many components more as motions without strain are free.
TEST(HeldScene, HoldsNoMoreThanItMust) {
  for (const int given : {0, 1, 3}) {
    Scene scene = testing::BlockUnderTraction({2, 2, 2}, {1, 1, 1});
    scene.supports.held.setConstant(false);
    scene.supports.held.col(0).head(given).setConstant(true);
    ASSERT_NE(WhyNotHeld(scene), "");
    const Scene held = HeldScene(scene);
    EXPECT_EQ(WhyNotHeld(held), "") << given;
    EXPECT_EQ(held.supports.held.count(), 6) << given;
    EXPECT_TRUE(held.supports.held.col(0).head(given).all());
    EXPECT_TRUE(held.is_rigid_motion_free);
  }
}

// Loads that balance are borne without reactions.
TEST(HeldScene, AddsNoReactions) {
  Scene scene = testing::BlockUnderTraction({2, 2, 2}, {1, 1, 1});
  Eigen::MatrixXd force = Eigen::MatrixXd::Zero(3, scene.mesh.NumNodes());
  force.rightCols(1).setConstant(3);
  force.leftCols(1).setConstant(-3);
  scene.load_cases[0].loads = {NodalForces{force}};
  // The two nodes lie on the line along which the forces pull.
  ASSERT_TRUE((scene.mesh.nodes.rightCols(1) - scene.mesh.nodes.leftCols(1))
                  .isApprox(Eigen::Vector3d::Ones()));
  scene.supports.held.setConstant(false);
  Scene held = HeldScene(scene);
  testing::Measure({5000, 0.3}, held);
  const Eigen::VectorXd internal =
      testing::DenseStiffness<double>(held.mesh,
                                      testing::HookeMatrix<double>(5000, 0.3)) *
      held.load_cases[0].displacement.reshaped();
  EXPECT_LT((internal - force.reshaped()).norm(), 1e-9 * force.norm());
}

// One that is in two pieces moves however the whole of it is held.
TEST(HeldScene, LeavesPiecesLoose) {
  Scene scene = testing::BlockUnderTraction({1, 1, 1}, {1, 1, 1});
  const Mesh one = scene.mesh;
  const Eigen::Index n = one.NumNodes();
  scene.mesh.nodes.conservativeResize(3, 2 * n);
  scene.mesh.nodes.rightCols(n) =
      one.nodes.colwise() + Eigen::Vector3d(5, 0, 0);
  scene.mesh.elements.conservativeResize(4, 2 * one.NumElements());
  scene.mesh.elements.rightCols(one.NumElements()) =
      one.elements.array() + int(n);
  scene.supports.held = ComponentMask::Constant(3, 2 * n, false);
  scene.supports.displacement = Eigen::MatrixXd::Zero(3, 2 * n);
  EXPECT_NE(WhyNotHeld(HeldScene(scene)), "");
}

}  // namespace
}  // namespace elastimate
