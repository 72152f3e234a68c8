#include "elastimate/core/mechanics/element_blocks.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstddef>
#include <vector>

#include "tests/scenes.h"

namespace elastimate {
namespace {

using testing::BoxMesh;

class BlocksOfALongBox : public ::testing::Test {
 protected:
  BlocksOfALongBox()
      : mesh_(BoxMesh({16, 16, 40}, {1, 1, 3})),
        chosen_(ChooseElementBlocks(mesh_)) {}

  Mesh mesh_;
  ElementBlocks chosen_;
};

TEST_F(BlocksOfALongBox, HoldEachElementOnceAndItsNodes) {
  ASSERT_GT(chosen_.blocks.size(), 2U);
  std::ptrdiff_t next = 0;
  std::ptrdiff_t most_nodes = 0;
  for (const ElementBlock& block : chosen_.blocks) {
    EXPECT_EQ(block.first, next);
    ASSERT_GT(block.end, block.first);
    const auto elements =
        mesh_.elements.middleCols(block.first, block.end - block.first);
    EXPECT_EQ(elements.minCoeff(), block.nodes.first);
    EXPECT_EQ(elements.maxCoeff() + 1, block.nodes.end);
    most_nodes = std::max(most_nodes, block.nodes.NumNodes());
    next = block.end;
  }
  EXPECT_EQ(next, mesh_.NumElements());
  EXPECT_EQ(chosen_.most_nodes, most_nodes);
}

TEST_F(BlocksOfALongBox, OfOneTurnShareNoNodes) {
  for (const std::size_t parity : {0, 1}) {
    std::vector<int> num_blocks(mesh_.NumNodes(), 0);
    for (std::size_t i = parity; i < chosen_.blocks.size(); i += 2) {
      const NodeRange& nodes = chosen_.blocks[i].nodes;
      for (std::ptrdiff_t node = nodes.first; node < nodes.end; ++node) {
        EXPECT_EQ(++num_blocks[node], 1);
      }
    }
  }
}

TEST_F(BlocksOfALongBox, AndTheGapsOfTheFirstTurnCoverTheNodesOnce) {
  std::vector<int> count(mesh_.NumNodes(), 0);
  const auto add = [&](const NodeRange& nodes) {
    for (std::ptrdiff_t node = nodes.first; node < nodes.end; ++node) {
      ++count[node];
    }
  };
  for (std::size_t i = 0; i < chosen_.blocks.size(); i += 2) {
    add(chosen_.blocks[i].nodes);
  }
  for (const NodeRange& gap : chosen_.gaps) {
    add(gap);
  }
  EXPECT_EQ(count, std::vector<int>(mesh_.NumNodes(), 1));
}

TEST(ElementBlocks, AreOneWithoutLocality) {
  Mesh mesh = BoxMesh({16, 16, 40}, {1, 1, 3});
  // Each second element comes from the other end.
  for (Eigen::Index e = 1; e < mesh.NumElements() / 2; e += 2) {
    mesh.elements.col(e).swap(mesh.elements.col(mesh.NumElements() - e));
  }
  const ElementBlocks chosen = ChooseElementBlocks(mesh);
  ASSERT_EQ(chosen.blocks.size(), 1U);
  EXPECT_EQ(chosen.blocks[0].end, mesh.NumElements());
  EXPECT_EQ(chosen.most_nodes, mesh.NumNodes());
}

}  // namespace
}  // namespace elastimate
