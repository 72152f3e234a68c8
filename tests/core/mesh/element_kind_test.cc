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
                  : topology.num_vertices + int(topology.edges.size()));
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

TEST(ElementTopology, FindsTheNodeInTheMiddleOfAnEdge) {
  const ElementTopology& tet10 = TopologyOf(ElementKind::kTet10);
  EXPECT_EQ(tet10.MidEdgeNode(0, 1), 4);
  EXPECT_EQ(tet10.MidEdgeNode(3, 2), 9);
  EXPECT_EQ(TopologyOf(ElementKind::kTri6).MidEdgeNode(2, 0), 5);
  EXPECT_EQ(TopologyOf(ElementKind::kHex8).MidEdgeNode(0, 1), -1);
}

TEST(ElementTopology, KnowsWhichKindsCanBeRaised) {
  EXPECT_EQ(QuadraticKind(ElementKind::kTet4), ElementKind::kTet10);
  EXPECT_EQ(QuadraticKind(ElementKind::kTri3), ElementKind::kTri6);
  for (const ElementKind kind :
       {ElementKind::kHex8, ElementKind::kQuad4, ElementKind::kTet10,
        ElementKind::kTri6, ElementKind::kCurvedTet10,
        ElementKind::kCurvedTri6}) {
    EXPECT_FALSE(HasQuadraticKind(kind));
  }
}

}  // namespace
}  // namespace elastimate
