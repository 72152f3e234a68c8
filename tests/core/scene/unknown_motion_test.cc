#include "elastimate/core/scene/unknown_motion.h"

#include <gtest/gtest.h>

#include "elastimate/core/scene/finer_scene.h"
#include "elastimate/core/scene/rigid_motion.h"
#include "tests/element_kinds.h"
#include "tests/scenes.h"
#include "tests/throws.h"

namespace elastimate {
namespace {

using Components = Eigen::Array<bool, Eigen::Dynamic, 1>;

// A cube that is held at its bottom by unknown motions.
Scene Cube() {
  const Mesh mesh = testing::BoxMesh({2, 2, 2}, {1, 1, 1});
  Scene scene = testing::HeldAtBottom(mesh, mesh, {0, 0, 1});
  scene.supports.unknown = scene.supports.held;
  return scene;
}

std::vector<int> HeldNodesOf(const Scene& scene) {
  std::vector<int> nodes;
  for (int node = 0; node < scene.mesh.NumNodes(); ++node) {
    if (scene.supports.held.col(node).any()) {
      nodes.push_back(node);
    }
  }
  return nodes;
}

TEST(UnknownMotionOfScene, HasAnAmountForEachMeasuredComponent) {
  Scene scene = Cube();
  EXPECT_TRUE(HasUnknownMotion(scene));
  const UnknownMotion motion(scene, scene.supports);
  EXPECT_EQ(motion.of_supports.cols(), scene.supports.held.count());
  EXPECT_EQ(motion.of_all.cols(), 0);
  scene.load_cases[0].displacement.setConstant(3, scene.mesh.NumNodes(), 2);
  const Eigen::VectorXd measured = MeasuredSupports(scene, 0);
  EXPECT_EQ(measured.sum(), 2.0 * double(scene.supports.held.count()));
  EXPECT_EQ((motion.of_supports * (motion.of_supports.transpose() * measured) -
             measured)
                .norm(),
            0);
}

TEST(UnknownMotionOfScene, HasTheRigidMotionsOfAFace) {
  Scene scene = Cube();
  const std::vector<int> nodes = HeldNodesOf(scene);
  scene.supports.rigid_faces = {{nodes, Components::Constant(3, true)}};
  const Eigen::MatrixXd motions =
      UnknownMotion(scene, scene.supports).of_supports;
  EXPECT_EQ(motions.cols(), 6);
  EXPECT_LT(
      (motions.transpose() * motions - Eigen::MatrixXd::Identity(6, 6)).norm(),
      1e-12);
  // Distances within the face stay what they are, to first order.
  for (const int a : nodes) {
    for (const int b : nodes) {
      const Eigen::RowVector3d arm =
          (scene.mesh.nodes.col(a) - scene.mesh.nodes.col(b)).transpose();
      EXPECT_LT(
          (arm * (motions.middleRows(3 * a, 3) - motions.middleRows(3 * b, 3)))
              .norm(),
          1e-12);
    }
  }
}

TEST(UnknownMotionOfScene, HasTheMotionsThatAFaceCanSay) {
  Scene scene = Cube();
  const std::vector<int> nodes = HeldNodesOf(scene);
  Components along_z = Components::Constant(3, false);
  along_z(2) = true;
  // A plane that stays one: a translation and two rotations.
  scene.supports.rigid_faces = {{nodes, along_z}};
  scene.supports.unknown.topRows(2).setConstant(false);
  EXPECT_EQ(UnknownMotion(scene, scene.supports).of_supports.cols(), 3);
  // Nodes of one edge do not turn about it.
  scene.supports.unknown = scene.supports.held;
  std::vector<int> edge;
  for (const int node : nodes) {
    if (scene.mesh.nodes(1, node) == 0) {
      edge.push_back(node);
    }
  }
  scene.supports.rigid_faces = {{edge, Components::Constant(3, true)}};
  const Eigen::Index of_others =
      scene.supports.held.count() - 3 * Eigen::Index(edge.size());
  EXPECT_EQ(UnknownMotion(scene, scene.supports).of_supports.cols(),
            of_others + 5);
}

// A step of the linear motions about where a face is, which another turn took
// there, leaves its distances what they are, by whatever angle it turns.
TEST(UnknownMotionOfScene, MovesAFaceByFiniteRotations) {
  Scene scene = Cube();
  const std::vector<int> nodes = HeldNodesOf(scene);
  scene.supports.rigid_faces = {{nodes, Components::Constant(3, true)}};
  const Eigen::MatrixXd& at_rest = scene.mesh.nodes;
  Eigen::VectorXd turn(6);
  turn << 0.1, 0.2, 0.3, 0.4, -0.5, 0.6;
  const Eigen::VectorXd displacement =
      (MovedRigidly(at_rest, turn) - at_rest).reshaped();
  const UnknownMotion motion(
      scene, scene.supports,
      {at_rest + displacement.reshaped(3, at_rest.cols()), at_rest});
  ASSERT_EQ(motion.of_supports.cols(), 6);
  const Eigen::VectorXd increment =
      motion.of_supports * Eigen::VectorXd::LinSpaced(6, -1, 1);
  const Eigen::MatrixXd moved =
      at_rest + (displacement + FiniteIncrement(scene.mesh, scene.supports,
                                                displacement, increment))
                    .reshaped(3, at_rest.cols());
  for (const int a : nodes) {
    for (const int b : nodes) {
      EXPECT_NEAR((moved.col(a) - moved.col(b)).norm(),
                  (at_rest.col(a) - at_rest.col(b)).norm(), 1e-12);
    }
  }
  // To first order, it is the increment.
  const Eigen::VectorXd small = 1e-4 * increment;
  const Eigen::VectorXd error =
      FiniteIncrement(scene.mesh, scene.supports, displacement, small) - small;
  EXPECT_LT(error.norm(), 1e-3 * small.norm());
  // Other supports move linearly.
  scene.supports.rigid_faces.clear();
  EXPECT_EQ(
      FiniteIncrement(scene.mesh, scene.supports, displacement, increment),
      increment);
}

TEST(UnknownMotionOfScene, OfAllIsRigid) {
  for (const testing::KindOfSection& kind : testing::AllKindsOfSections()) {
    Scene scene = testing::SceneOfKind(kind);
    EXPECT_FALSE(HasUnknownMotion(scene));
    scene.is_rigid_motion_free = true;
    EXPECT_TRUE(HasUnknownMotion(scene));
    const UnknownMotion motion(scene, scene.supports);
    EXPECT_EQ(motion.of_all.cols(), scene.mesh.Dimension() == 3 ? 6 : 3);
    EXPECT_EQ(motion.of_supports.cols(), 0);
    EXPECT_EQ(motion.NumAmounts(), motion.of_all.cols());
  }
}

// Twice refined, a support that moved as measured has as many amounts as
// before, and moves linearly between its nodes.
TEST(UnknownMotionOfScene, OfNodesThatRefinementAddedIsThatOfTheirEnds) {
  Scene scene = Cube();
  scene.load_cases[0].displacement.setZero(3, scene.mesh.NumNodes());
  const Eigen::Index num_amounts =
      UnknownMotion(scene, scene.supports).NumAmounts();
  const Scene finer = FinerScene(FinerScene(scene));
  const UnknownMotion motion(finer, finer.supports);
  EXPECT_EQ(motion.NumAmounts(), num_amounts);
  const Eigen::Matrix3d gradient{{1, 2, 3}, {4, 5, 6}, {7, 8, 10}};
  Eigen::VectorXd linear = (gradient * finer.mesh.nodes).reshaped();
  const ComponentMask mask = AsMeasured(finer.supports);
  const Eigen::Array<bool, Eigen::Dynamic, 1> held = mask.reshaped();
  linear = held.select(linear, 0.0).eval();
  Eigen::VectorXd amounts(num_amounts);
  Eigen::Index next = 0;
  for (Eigen::Index dof = 0; dof < scene.mesh.NumDofs(); ++dof) {
    if (held(dof)) {
      amounts(next++) = linear(dof);
    }
  }
  ASSERT_EQ(next, num_amounts);
  EXPECT_LT((motion.of_supports * amounts - linear).norm(),
            1e-12 * linear.norm());
}

TEST(UnknownMotionOfScene, IsRefusedWithOneResultantTwice) {
  Scene scene = Cube();
  const Resultant resultant = {HeldNodesOf(scene), Eigen::Vector3d(0, 0, 1),
                               Eigen::Vector3d::Constant(0.1)};
  scene.load_cases[0].resultants = {resultant};
  EXPECT_NO_THROW(ValidateUnknownMotion(scene));
  scene.load_cases[0].resultants.push_back(resultant);
  EXPECT_THROWS_WITH(ValidateUnknownMotion(scene),
                     "resultant 2 of load case 1 measures a force on the same");
  // Another component of the same nodes is another measurement.
  scene.load_cases[0].resultants[0].force << testing::kNan, 1, testing::kNan;
  scene.load_cases[0].resultants[1].force << 1, testing::kNan, testing::kNan;
  EXPECT_NO_THROW(ValidateUnknownMotion(scene));
}

}  // namespace
}  // namespace elastimate
