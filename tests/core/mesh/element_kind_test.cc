#include "elastimate/core/mesh/element_kind.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <map>
#include <set>
#include <utility>

namespace elastimate {
namespace {

std::pair<int, int> Sorted(int a, int b) { return std::minmax(a, b); }

TEST(ElementTopology, HasTheNumbersOfEuler) {
  // Vertices - edges + faces: 2 of a body, 0 of a polygon.
  for (const ElementKind kind : kElementKinds) {
    const ElementTopology& topology = TopologyOf(kind);
    SCOPED_TRACE(topology.name);
    EXPECT_EQ(topology.dimension, DimensionOf(kind));
    const int faces =
        topology.dimension == 3 ? static_cast<int>(topology.faces.size()) : 0;
    EXPECT_EQ(topology.num_vertices - int(topology.edges.size()) + faces,
              topology.dimension == 3 ? 2 : 0);
    EXPECT_EQ(topology.num_nodes,
              topology.order == 1
                  ? topology.num_vertices
                  : topology.num_vertices + int(topology.middles.size()));
    const bool is_simplex = topology.num_vertices == topology.dimension + 1;
    EXPECT_EQ(int(topology.middles.size()),
              int(topology.edges.size()) + (is_simplex ? 0 : faces + 1));
  }
}

// Each edge of a closed and oriented surface is walked once in each direction.
TEST(ElementTopology, HasFacesThatCloseItsSurface) {
  for (const ElementKind kind : kElementKinds) {
    const ElementTopology& topology = TopologyOf(kind);
    SCOPED_TRACE(topology.name);
    std::set<std::pair<int, int>> edges;
    for (const auto& [a, b] : topology.edges) {
      edges.insert(Sorted(a, b));
    }
    EXPECT_EQ(edges.size(), topology.edges.size());
    std::map<std::pair<int, int>, int> walked;
    for (const std::vector<int>& face : topology.faces) {
      const std::size_t num_steps = face.size() == 2 ? 1 : face.size();
      for (std::size_t i = 0; i < num_steps; ++i) {
        const int a = face[i];
        const int b = face[(i + 1) % face.size()];
        EXPECT_EQ(edges.count(Sorted(a, b)), 1U);
        walked[Sorted(a, b)] += topology.dimension == 2 ? 1 : a < b ? 1 : -1;
      }
    }
    for (const auto& [edge, sum] : walked) {
      EXPECT_EQ(sum, topology.dimension == 2 ? 1 : 0);
    }
    EXPECT_EQ(walked.size(), topology.edges.size());
  }
}

TEST(ElementTopology, FindsTheNodeInTheMiddleOfVertices) {
  const ElementTopology& tet10 = TopologyOf(ElementKind::kTet10);
  EXPECT_EQ(tet10.MiddleNode({0, 1}), 4);
  EXPECT_EQ(tet10.MiddleNode({3, 2}), 9);
  EXPECT_EQ(tet10.MiddleNode({0, 1, 2}), -1);
  EXPECT_EQ(TopologyOf(ElementKind::kTri6).MiddleNode({2, 0}), 5);
  EXPECT_EQ(TopologyOf(ElementKind::kHex8).MiddleNode({0, 1}), -1);
  const ElementTopology& hex27 = TopologyOf(ElementKind::kHex27);
  EXPECT_EQ(hex27.MiddleNode({6, 2}), 18);
  EXPECT_EQ(hex27.MiddleNode({7, 4, 0, 3}), 20);
  EXPECT_EQ(hex27.MiddleNode({0, 1, 2, 3, 4, 5, 6, 7}), 26);
  EXPECT_EQ(TopologyOf(ElementKind::kQuad9).MiddleNode({0, 1, 2, 3}), 8);
}

TEST(ElementTopology, KnowsTheKindsOfEachOrder) {
  for (const ElementKind kind : kElementKinds) {
    const ElementTopology& topology = TopologyOf(kind);
    SCOPED_TRACE(topology.name);
    for (const ElementKind other : {LinearKind(kind), QuadraticKind(kind)}) {
      EXPECT_EQ(TopologyOf(other).order, other == LinearKind(kind) ? 1 : 2);
      EXPECT_EQ(TopologyOf(other).shape, topology.shape);
      EXPECT_FALSE(IsCurved(other));
    }
  }
}

}  // namespace
}  // namespace elastimate
