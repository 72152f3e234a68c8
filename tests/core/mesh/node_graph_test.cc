#include "elastimate/core/mesh/node_graph.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <set>
#include <utility>

#include "tests/core/random_values.h"
#include "tests/scenes.h"

namespace elastimate {
namespace {

using testing::BoxMesh;
using testing::Distorted;
using testing::WithBothOrientations;

class NodeGraphOfABox : public ::testing::Test {
 protected:
  NodeGraphOfABox()
      : mesh_(
            WithBothOrientations(Distorted(BoxMesh({3, 2, 2}, {1, 0.8, 1.2})))),
        graph_(mesh_) {}

  Mesh mesh_;
  NodeGraph graph_;
};

TEST_F(NodeGraphOfABox, HasEachPairOfEachElementOnce) {
  std::set<std::pair<int, int>> expected;
  for (Eigen::Index e = 0; e < mesh_.NumElements(); ++e) {
    for (const int i : mesh_.elements.col(e)) {
      for (const int j : mesh_.elements.col(e)) {
        if (i >= j) {
          expected.emplace(j, i);
        }
      }
    }
  }
  // A set is in the order of columns, then rows: so are the pairs.
  ASSERT_EQ(graph_.NumPairs(), static_cast<Eigen::Index>(expected.size()));
  ASSERT_EQ(graph_.start.size(),
            static_cast<std::size_t>(mesh_.NumNodes() + 1));
  EXPECT_EQ(graph_.start.front(), 0);
  EXPECT_EQ(graph_.start.back(), graph_.NumPairs());
  Eigen::Index k = 0;
  for (const auto& [column, row] : expected) {
    EXPECT_EQ(graph_.row[k], row);
    EXPECT_LE(graph_.start[column], k);
    EXPECT_GT(graph_.start[column + 1], k);
    ++k;
  }
}

TEST_F(NodeGraphOfABox, BeginsEachColumnWithTheDiagonal) {
  for (Eigen::Index node = 0; node < mesh_.NumNodes(); ++node) {
    EXPECT_EQ(graph_.row[graph_.start[node]], node);
  }
}

TEST_F(NodeGraphOfABox, KnowsThePairsOfEachElement) {
  ASSERT_EQ(graph_.element_pairs.rows(), 10);
  ASSERT_EQ(graph_.element_pairs.cols(), mesh_.NumElements());
  for (Eigen::Index e = 0; e < mesh_.NumElements(); ++e) {
    for (int i = 0; i < 4; ++i) {
      for (int j = 0; j < 4; ++j) {
        const int pair = graph_.element_pairs(NodeGraph::LocalPair(i, j), e);
        const auto [column, row] =
            std::minmax(mesh_.elements(i, e), mesh_.elements(j, e));
        EXPECT_EQ(graph_.row[pair], row);
        EXPECT_GE(pair, graph_.start[column]);
        EXPECT_LT(pair, graph_.start[column + 1]);
      }
    }
  }
}

}  // namespace
}  // namespace elastimate
