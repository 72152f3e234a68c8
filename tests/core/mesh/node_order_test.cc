#include "elastimate/core/mesh/node_order.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <random>
#include <vector>

#include "tests/scenes.h"

namespace elastimate {
namespace {

using testing::BoxMesh;
using testing::Distorted;

Mesh WithShuffledElements(Mesh mesh) {
  std::vector<int> order(mesh.NumElements());
  for (std::size_t i = 0; i < order.size(); ++i) {
    order[i] = static_cast<int>(i);
  }
  std::shuffle(order.begin(), order.end(), std::mt19937(1));
  mesh.elements = mesh.elements(Eigen::all, order).eval();
  return mesh;
}

// Two bodies that touch nowhere.
Mesh Twice(const Mesh& mesh) {
  Mesh both;
  both.nodes.resize(3, 2 * mesh.NumNodes());
  both.nodes << mesh.nodes, mesh.nodes.colwise() + Eigen::Vector3d(9, 0, 0);
  both.elements.resize(4, 2 * mesh.NumElements());
  both.elements << mesh.elements,
      mesh.elements.array() + static_cast<int>(mesh.NumNodes());
  return both;
}

// The elements of the mesh that was ordered, sorted.
std::vector<std::array<int, 4>> SortedElements(
    const Mesh& mesh, const std::vector<int>* places = nullptr) {
  std::vector<std::array<int, 4>> elements(mesh.NumElements());
  for (Eigen::Index e = 0; e < mesh.NumElements(); ++e) {
    for (int i = 0; i < 4; ++i) {
      const int node = mesh.elements(i, e);
      elements[e][i] = places == nullptr ? node : places->at(node);
    }
  }
  std::sort(elements.begin(), elements.end());
  return elements;
}

void ExpectPermuted(const Mesh& mesh, const OrderedMesh& ordered) {
  ASSERT_EQ(ordered.mesh.NumNodes(), mesh.NumNodes());
  std::vector<int> sorted = ordered.places;
  std::sort(sorted.begin(), sorted.end());
  for (std::size_t i = 0; i < sorted.size(); ++i) {
    ASSERT_EQ(sorted[i], static_cast<int>(i));
  }
  EXPECT_EQ(ordered.mesh.nodes, mesh.nodes(Eigen::all, ordered.places));
  EXPECT_EQ(SortedElements(ordered.mesh, &ordered.places),
            SortedElements(mesh));
  ASSERT_EQ(ordered.element_places.size(), std::size_t(mesh.NumElements()));
  for (Eigen::Index e = 0; e < mesh.NumElements(); ++e) {
    for (int i = 0; i < 4; ++i) {
      ASSERT_EQ(ordered.places[ordered.mesh.elements(i, e)],
                mesh.elements(i, ordered.element_places[e]));
    }
  }
}

TEST(OrderForLocality, PermutesNodesAndElements) {
  const Mesh mesh = Distorted(BoxMesh({3, 4, 5}, {1, 0.8, 1.2}));
  ExpectPermuted(mesh, OrderForLocality(mesh));
  ExpectPermuted(WithShuffledElements(mesh),
                 OrderForLocality(WithShuffledElements(mesh)));
}

TEST(OrderForLocality, FindsPartsThatAreNotConnected) {
  const Mesh mesh = Twice(BoxMesh({2, 3, 2}, {1, 1, 1}));
  ExpectPermuted(mesh, OrderForLocality(mesh));
}

// In a bar, fronts of the search are cross-sections.
TEST(OrderForLocality, KeepsTheNodesOfAnElementTogether) {
  const Mesh bar = WithShuffledElements(BoxMesh({40, 2, 2}, {40, 2, 2}));
  const OrderedMesh ordered = OrderForLocality(bar);
  constexpr int kNodesOfCrossSection = 9;
  for (const auto element : ordered.mesh.elements.colwise()) {
    EXPECT_LT(element.maxCoeff() - element.minCoeff(),
              3 * kNodesOfCrossSection);
  }
}

TEST(HasLocality, TellsAShuffledMeshFromOneThatIsNot) {
  const Mesh mesh = BoxMesh({20, 20, 20}, {1, 1, 1});
  EXPECT_TRUE(HasLocality(mesh));
  const Mesh shuffled = WithShuffledElements(mesh);
  EXPECT_FALSE(HasLocality(shuffled));
  EXPECT_TRUE(HasLocality(OrderForLocality(shuffled).mesh));
}

TEST(HasLocality, OfASmallMeshDoesNotDependOnItsOrder) {
  EXPECT_TRUE(HasLocality(WithShuffledElements(BoxMesh({4, 4, 4}, {1, 1, 1}))));
}

}  // namespace
}  // namespace elastimate
