#include "elastimate/core/scene/rigid_motion.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "tests/scenes.h"

namespace elastimate {
namespace {

using testing::BoxMesh;
using ::testing::ContainsRegex;
using testing::Distorted;
using ::testing::HasSubstr;
using ::testing::IsEmpty;

// Supports of a mesh, held one component at a time.
class HeldBox : public ::testing::Test {
 protected:
  // Node i + 3 (j + 3 k) is at (i, j, k) / 2 of the edges 1, 2, 3.
  HeldBox() : mesh_(BoxMesh({2, 2, 2}, {1, 2, 3})) { Release(); }

  void Release() {
    supports_.held = ComponentMask::Constant(3, mesh_.NumNodes(), false);
    supports_.displacement = Eigen::MatrixXd::Zero(3, mesh_.NumNodes());
  }
  void Hold(int node, const std::string& components) {
    for (const char component : components) {
      supports_.held(component - 'x', node) = true;
    }
  }
  std::string Why() const { return WhyNotHeld(mesh_, supports_); }

  static constexpr int kOrigin = 0;
  static constexpr int kAlongX = 2;
  static constexpr int kAlongY = 6;
  static constexpr int kAlongZ = 18;
  static constexpr int kOpposite = 26;

  Mesh mesh_;
  Supports supports_;
};

TEST_F(HeldBox, WithoutSupportsMoves) {
  EXPECT_THAT(Why(), ContainsRegex("the part of the mesh around node 0 "
                                   "(move along|rotate about) [xyz] "
                                   "without strain; hold more components"));
}

TEST_F(HeldBox, AtOneNodeRotates) {
  for (const int node : {kOrigin, kAlongX, kAlongY, kAlongZ, kOpposite, 13}) {
    Release();
    Hold(node, "xyz");
    EXPECT_THAT(Why(), ContainsRegex("rotate about [xyz]")) << node;
  }
}

TEST_F(HeldBox, AtTwoNodesTurnsAboutTheirLine) {
  Hold(kOrigin, "xyz");
  Hold(kAlongZ, "xyz");
  EXPECT_THAT(Why(), HasSubstr("rotate about z"));
  Release();
  Hold(kOrigin, "xyz");
  Hold(kAlongX, "xyz");
  EXPECT_THAT(Why(), HasSubstr("rotate about x"));
  Release();
  Hold(kOrigin, "xyz");
  Hold(kOpposite, "xyz");
  EXPECT_THAT(Why(), HasSubstr("rotate about (0.27, 0.53, 0.8) without"));
}

// About an axis at a corner, the centroid moves along z by more than either
// component of the rotation.
TEST_F(HeldBox, TurnsAboutAnAxisFarFromItsCentroid) {
  mesh_ = BoxMesh({10, 10, 1}, {1, 1, 0.01});
  Release();
  Hold(9 + 11 * 10, "xyz");
  Hold(10 + 11 * 9, "xyz");
  EXPECT_THAT(Why(),
              ContainsRegex("rotate about \\(-?0.71, -?0.71, 0\\) without"));
}

TEST_F(HeldBox, MovesWhenItCanMoveAndRotate) {
  supports_.held.row(2).setConstant(true);
  EXPECT_THAT(Why(), ContainsRegex(" move along [xy] "));
  Release();
  EXPECT_THAT(Why(), ContainsRegex(" move along [xyz] "));
}

TEST_F(HeldBox, AtThreeNodesOfALineTurnsAboutIt) {
  Hold(kOrigin, "xyz");
  Hold(3, "xyz");
  Hold(kAlongY, "xyz");
  EXPECT_THAT(Why(), HasSubstr("rotate about y"));
}

TEST_F(HeldBox, AtThreeNodesIsHeld) {
  Hold(kOrigin, "xyz");
  Hold(kAlongX, "xyz");
  Hold(kAlongY, "xyz");
  EXPECT_THAT(Why(), IsEmpty());
}

TEST_F(HeldBox, InOneComponentEverywhereSlides) {
  for (int axis = 0; axis < 3; ++axis) {
    Release();
    supports_.held.row(axis).setConstant(true);
    EXPECT_THAT(Why(), ContainsRegex("(move along|rotate about) [xyz]"));
  }
}

TEST_F(HeldBox, InTwoComponentsEverywhereMovesAlongTheThird) {
  supports_.held.topRows(2).setConstant(true);
  EXPECT_THAT(Why(), HasSubstr("move along z"));
}

// 3 + 2 + 1 components: each takes away one of the six rigid motions.
TEST_F(HeldBox, IsHeldByAStaticallyDeterminateSupport) {
  Hold(kOrigin, "xyz");
  Hold(kAlongX, "yz");
  Hold(kAlongY, "z");
  EXPECT_THAT(Why(), IsEmpty());
  const ComponentMask enough = supports_.held;
  for (Eigen::Index dof = 0; dof < enough.size(); ++dof) {
    if (enough.data()[dof]) {
      supports_.held = enough;
      supports_.held.data()[dof] = false;
      EXPECT_NE(Why(), "") << "without component " << dof;
    }
  }
}

// x of the second node says nothing that x of the first did not.
TEST_F(HeldBox, IsNotHeldByAnySixComponents) {
  Hold(kOrigin, "xyz");
  Hold(kAlongX, "xy");
  Hold(kAlongY, "z");
  EXPECT_THAT(Why(), HasSubstr("rotate about y"));
}

TEST_F(HeldBox, DoesNotDependOnUnitsOrPlace) {
  const Eigen::MatrixXd nodes = Distorted(mesh_).nodes;
  for (const double unit : {1e-9, 1e-3, 1.0, 1e3, 1e9}) {
    for (const double place : {0.0, 100.0}) {
      mesh_.nodes = unit * (nodes.array() + place).matrix();
      Release();
      Hold(kOrigin, "xyz");
      Hold(kAlongX, "yz");
      EXPECT_NE(Why(), "") << unit << " " << place;
      Hold(kAlongY, "z");
      EXPECT_EQ(Why(), "") << unit << " " << place;
    }
  }
}

TEST(RigidMotionNearest, IsTheMotionWhoseFirstOrderIsGiven) {
  for (const int dimension : {2, 3}) {
    const Eigen::MatrixXd points =
        Eigen::MatrixXd::Random(dimension, 7).array() + 5;
    const Eigen::VectorXd middle = points.rowwise().mean();
    Eigen::VectorXd motion =
        Eigen::VectorXd::LinSpaced(NumRigidMotions(dimension), 0.3, 0.7);
    // A rotation about the middle, which stays where it is but for the
    // translation.
    const Eigen::MatrixXd change =
        (RigidMotionsOf(points.colwise() - middle) * motion)
            .reshaped(dimension, points.cols());
    const Eigen::VectorXd found = RigidMotionNearest(points, change);
    const Eigen::VectorXd translation = motion.head(dimension);
    motion.head(dimension) += middle;
    EXPECT_LT((MovedRigidly(points, found) -
               MovedRigidly(points.colwise() - middle, motion))
                  .norm(),
              1e-12);
    EXPECT_LT((MovedRigidly(middle, found) - middle - translation).norm(),
              1e-12);
  }
}

TEST(WhyNotHeld, NamesThePartThatIsFree) {
  const Mesh box = BoxMesh({1, 1, 1}, {1, 1, 1});
  Mesh mesh;
  mesh.nodes.resize(3, 16);
  mesh.nodes << box.nodes, (box.nodes.array() + 5).matrix();
  mesh.elements.resize(4, 12);
  mesh.elements << box.elements, (box.elements.array() + 8).matrix();
  Supports supports{ComponentMask::Constant(3, 16, false),
                    Eigen::MatrixXd::Zero(3, 16)};
  supports.held.leftCols(8).setConstant(true);
  EXPECT_THAT(WhyNotHeld(mesh, supports),
              HasSubstr("the part of the mesh around node 8 "));
  supports.held.rightCols(3).setConstant(true);
  EXPECT_EQ(WhyNotHeld(mesh, supports), "");
  supports.held.leftCols(8).setConstant(false);
  EXPECT_THAT(WhyNotHeld(mesh, supports),
              HasSubstr("the part of the mesh around node 0 "));
}

// Tetrahedra, each of which shares a node with the next.
class Chain : public ::testing::TestWithParam<int> {
 protected:
  Chain() {
    const int num_bodies = GetParam();
    mesh_.nodes.resize(3, 3 * num_bodies + 1);
    mesh_.elements.resize(4, num_bodies);
    mesh_.nodes.col(0).setZero();
    for (int e = 0; e < num_bodies; ++e) {
      const Eigen::Vector3d shared = mesh_.nodes.col(3 * e);
      mesh_.nodes.middleCols(3 * e + 1, 3) =
          Eigen::Matrix3d::Identity().colwise() + shared;
      mesh_.elements.col(e) << 3 * e, 3 * e + 1, 3 * e + 2, 3 * e + 3;
    }
    supports_.held = ComponentMask::Constant(3, mesh_.NumNodes(), false);
    supports_.displacement = Eigen::MatrixXd::Zero(3, mesh_.NumNodes());
  }

  Mesh mesh_;
  Supports supports_;
};

TEST_P(Chain, MovesAsAWhole) {
  supports_.held.row(0).setConstant(true);
  EXPECT_THAT(WhyNotHeld(mesh_, supports_),
              ContainsRegex("the part of the mesh around node 0 move along "
                            "[yz] without strain; hold more components$"));
}

TEST_P(Chain, OfHeldNodesIsHeld) {
  supports_.held.setConstant(true);
  EXPECT_THAT(WhyNotHeld(mesh_, supports_), IsEmpty());
}

TEST(SeparateBoxes, AreSaidToShareNoNode) {
  // The second box stands on the first one, on nodes of its own.
  const Mesh box = BoxMesh({1, 1, 1}, {1, 1, 1});
  Mesh mesh;
  mesh.nodes.resize(3, 2 * box.NumNodes());
  mesh.nodes << box.nodes, box.nodes.colwise() + Eigen::Vector3d::UnitZ();
  mesh.elements.resize(4, 2 * box.NumElements());
  mesh.elements << box.elements,
      box.elements.array() + static_cast<int>(box.NumNodes());
  Supports supports;
  supports.held = ComponentMask::Constant(3, mesh.NumNodes(), false);
  supports.held.leftCols(4).setConstant(true);
  supports.displacement = Eigen::MatrixXd::Zero(3, mesh.NumNodes());
  EXPECT_THAT(
      WhyNotHeld(mesh, supports),
      ContainsRegex("around node 8 .* hold more components \\(it shares "
                    "no node with the rest of the mesh"));
}

// The rest is held at its nodes, and the part in the middle by its neighbours
// at two of its own.
TEST_P(Chain, TurnsInTheMiddle) {
  const int middle = GetParam() / 2;
  supports_.held.setConstant(true);
  supports_.held.middleCols(3 * middle + 1, 2).setConstant(false);
  EXPECT_THAT(WhyNotHeld(mesh_, supports_),
              ContainsRegex("around node " + std::to_string(3 * middle + 1) +
                            " rotate about .* without strain; .* mend the "
                            "mesh"));
  supports_.held(0, 3 * middle + 2) = true;
  EXPECT_THAT(WhyNotHeld(mesh_, supports_), IsEmpty());
}

TEST_P(Chain, HeldAtItsEndsTurns) {
  supports_.held.leftCols(4).setConstant(true);
  supports_.held.rightCols(3).setConstant(true);
  EXPECT_THAT(WhyNotHeld(mesh_, supports_),
              ContainsRegex("around node 4 rotate about .* mend the mesh"));
}

INSTANTIATE_TEST_SUITE_P(NumBodies, Chain, ::testing::Values(3, 64, 65, 1000));

// Two boxes of many tetrahedra that share the nodes of one edge, or one node.
class HingedBoxes : public ::testing::Test {
 protected:
  explicit HingedBoxes(Eigen::Index num_shared = 4) {
    const Mesh box = BoxMesh({3, 3, 3}, {1, 1, 1});
    const Eigen::Index num_nodes = box.NumNodes();
    // The nodes of the upper box along y at x = 1, z = 1 are those of the
    // lower.
    std::vector<int> number(num_nodes, -1);
    Eigen::MatrixXd nodes(3, 2 * num_nodes);
    nodes.leftCols(num_nodes) = box.nodes;
    Eigen::Index next = num_nodes;
    const auto id = [](int i, int j, int k) { return i + 4 * (j + 4 * k); };
    for (int j = 0; j < num_shared; ++j) {
      number[id(0, j, 0)] = id(3, j, 3);
    }
    for (Eigen::Index node = 0; node < num_nodes; ++node) {
      if (number[node] < 0) {
        nodes.col(next) = box.nodes.col(node) + Eigen::Vector3d(1, 0, 1);
        number[node] = static_cast<int>(next++);
      }
    }
    mesh_.nodes = nodes.leftCols(next);
    mesh_.elements.resize(4, 2 * box.NumElements());
    mesh_.elements << box.elements,
        box.elements.unaryExpr([&](int node) { return number[node]; });
    supports_.held = ComponentMask::Constant(3, next, false);
    supports_.displacement = Eigen::MatrixXd::Zero(3, next);
    supports_.held.leftCols(16).setConstant(true);
  }

  Mesh mesh_;
  Supports supports_;
};

TEST_F(HingedBoxes, TurnAboutTheSharedEdge) {
  EXPECT_THAT(WhyNotHeld(mesh_, supports_),
              ContainsRegex("around node 64 rotate about y without strain; .* "
                            "mend the mesh"));
  // One more component off the axis.
  supports_.held(0, mesh_.NumNodes() - 1) = true;
  EXPECT_THAT(WhyNotHeld(mesh_, supports_), IsEmpty());
}

class BoxesAtANode : public HingedBoxes {
 protected:
  BoxesAtANode() : HingedBoxes(1) {}
};

TEST_F(BoxesAtANode, TurnAboutAnyAxis) {
  EXPECT_THAT(WhyNotHeld(mesh_, supports_), HasSubstr("rotate about"));
  supports_.held.rightCols(3).setConstant(true);
  EXPECT_THAT(WhyNotHeld(mesh_, supports_), IsEmpty());
}

}  // namespace
}  // namespace elastimate
