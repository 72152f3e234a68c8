#include "elastimate/core/mesh/coincident_nodes.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/element_kinds.h"
#include "tests/scenes.h"

namespace elastimate {
namespace {

using testing::BoxMesh;
using testing::Distorted;
using ::testing::ElementsAre;
using ::testing::IsEmpty;
using ::testing::SizeIs;

// `first` and `second` side by side, with no node in common.
Mesh Together(const Mesh& first, const Mesh& second) {
  Mesh mesh;
  mesh.nodes.resize(3, first.NumNodes() + second.NumNodes());
  mesh.nodes << first.nodes, second.nodes;
  mesh.elements.resize(4, first.NumElements() + second.NumElements());
  mesh.elements << first.elements,
      second.elements.array() + static_cast<int>(first.NumNodes());
  return mesh;
}

Mesh Moved(Mesh mesh, const Eigen::Vector3d& shift) {
  mesh.nodes.colwise() += shift;
  return mesh;
}

TEST(CoincidentNodes, AreNoneInAMesh) {
  EXPECT_THAT(CoincidentNodes(BoxMesh({6, 5, 4}, {2, 3, 4})), IsEmpty());
  EXPECT_THAT(CoincidentNodes(Distorted(BoxMesh({6, 5, 4}, {2, 3, 4}))),
              IsEmpty());
}

TEST(CoincidentNodes, AreNoneInAMeshOfAnyKind) {
  for (const testing::KindOfSection& parameter :
       testing::AllKindsOfSections()) {
    SCOPED_TRACE(testing::NameOf(parameter));
    EXPECT_THAT(CoincidentNodes(testing::MeshOfKind(parameter)), IsEmpty());
  }
}

TEST(CoincidentNodes, AreMidEdgeNodesToo) {
  Mesh mesh =
      testing::MeshOfKind({ElementKind::kTri6, SectionModel::kPlaneStress}, 1);
  const int vertex = mesh.elements(0, 0);
  const int middle = mesh.elements(3, 0);
  mesh.nodes.col(middle) = mesh.nodes.col(vertex);
  EXPECT_THAT(CoincidentNodes(mesh), SizeIs(2));
}

TEST(CoincidentNodes, AreThoseOfAnInterfaceThatIsNotMerged) {
  // The boxes touch in a face of 3 x 4 nodes.
  const Mesh below = BoxMesh({2, 3, 2}, {2, 3, 4});
  const Mesh mesh = Together(below, Moved(below, {0, 0, 4}));
  const auto nodes = CoincidentNodes(mesh);
  ASSERT_THAT(nodes, SizeIs(2 * 3 * 4));
  for (const auto& [node, other] : nodes) {
    EXPECT_NE(node, other);
    EXPECT_EQ(mesh.nodes.col(node), mesh.nodes.col(other));
    EXPECT_EQ(mesh.nodes(2, node), 4);
  }
}

TEST(CoincidentNodes, AreMeasuredByTheEdgesAroundThem) {
  const Mesh below = BoxMesh({2, 3, 2}, {2, 3, 4});
  for (const double size : {1e-12, 1.0, 1e12}) {
    const auto count = [&](double gap) {
      Mesh mesh = Together(below, Moved(below, {0, 0, 4 + gap}));
      mesh.nodes *= size;
      return CoincidentNodes(mesh).size();
    };
    EXPECT_EQ(count(1e-6), 24);  // As files in single precision have it.
    EXPECT_EQ(count(-1e-6), 24);
    EXPECT_EQ(count(1e-3), 0);
  }
}

TEST(CoincidentNodes, FindEachOfManyAtOnePlace) {
  // Every tetrahedron has nodes of its own.
  const Mesh box = BoxMesh({3, 3, 3}, {1, 1, 1});
  Mesh exploded;
  exploded.nodes.resize(3, 4 * box.NumElements());
  exploded.elements.resize(4, box.NumElements());
  for (Eigen::Index e = 0; e < box.NumElements(); ++e) {
    for (int i = 0; i < 4; ++i) {
      exploded.elements(i, e) = static_cast<int>(4 * e + i);
      exploded.nodes.col(4 * e + i) = box.nodes.col(box.elements(i, e));
    }
  }
  Eigen::VectorXi uses = Eigen::VectorXi::Zero(box.NumNodes());
  for (const int node : box.elements.reshaped()) {
    ++uses(node);
  }
  // The corners of the box that one tetrahedron has to itself.
  const Eigen::Index alone = (uses.array() == 1).count();
  EXPECT_THAT(CoincidentNodes(exploded), SizeIs(exploded.NumNodes() - alone));
}

TEST(CoincidentNodes, ComeInAscendingOrder) {
  Mesh mesh;
  mesh.nodes.resize(3, 8);
  mesh.nodes << 0, 1, 0, 0, 0, 0, -1, 0,  //
      0, 0, 1, 0, 1, 0, 0, 0,             //
      0, 0, 0, 1, 0, -1, 0, 0;
  mesh.elements.resize(4, 2);
  mesh.elements << 0, 4, 1, 5, 2, 6, 3, 7;
  const auto nodes = CoincidentNodes(mesh);
  EXPECT_THAT(nodes, ElementsAre(ElementsAre(0, 7), ElementsAre(2, 4),
                                 ElementsAre(4, 2), ElementsAre(7, 0)));
}

}  // namespace
}  // namespace elastimate
