#include "elastimate/core/mechanics/element_blocks.h"

#include <algorithm>

namespace elastimate {
namespace {

std::vector<ElementBlock> BlocksOf(const Mesh& mesh,
                                   std::ptrdiff_t elements_per_block) {
  std::vector<ElementBlock> blocks;
  for (std::ptrdiff_t first = 0; first < mesh.NumElements();
       first += elements_per_block) {
    const std::ptrdiff_t end =
        std::min(first + elements_per_block, mesh.NumElements());
    int first_node = mesh.elements(0, first);
    int last_node = first_node;
    const std::ptrdiff_t num_nodes = mesh.elements.rows();
    for (std::ptrdiff_t i = num_nodes * first; i < num_nodes * end; ++i) {
      const int node = mesh.elements.data()[i];
      first_node = std::min(first_node, node);
      last_node = std::max(last_node, node);
    }
    blocks.push_back({first, end, {first_node, last_node + 1}});
  }
  return blocks;
}

// Returns the blocks with each two neighbours merged into one.
std::vector<ElementBlock> Merged(const std::vector<ElementBlock>& blocks) {
  std::vector<ElementBlock> merged;
  for (std::size_t i = 0; i < blocks.size(); i += 2) {
    const ElementBlock& a = blocks[i];
    const ElementBlock& b = blocks[std::min(i + 1, blocks.size() - 1)];
    merged.push_back({a.first,
                      b.end,
                      {std::min(a.nodes.first, b.nodes.first),
                       std::max(a.nodes.end, b.nodes.end)}});
  }
  return merged;
}

// Returns the node ranges of the blocks first, first + 2, .., in ascending
// order.
std::vector<NodeRange> NodeRanges(const std::vector<ElementBlock>& blocks,
                                  std::size_t first) {
  std::vector<NodeRange> ranges;
  for (std::size_t i = first; i < blocks.size(); i += 2) {
    ranges.push_back(blocks[i].nodes);
  }
  std::sort(
      ranges.begin(), ranges.end(),
      [](const NodeRange& a, const NodeRange& b) { return a.first < b.first; });
  return ranges;
}

bool AreDisjoint(const std::vector<NodeRange>& ranges) {
  for (std::size_t i = 1; i < ranges.size(); ++i) {
    if (ranges[i].first < ranges[i - 1].end) {
      return false;
    }
  }
  return true;
}

bool AreSuitable(const std::vector<ElementBlock>& blocks,
                 std::ptrdiff_t num_nodes) {
  constexpr double kMostCopies = 1.5;
  std::ptrdiff_t num_copies = 0;
  for (const ElementBlock& block : blocks) {
    num_copies += block.nodes.NumNodes();
  }
  return static_cast<double>(num_copies) <=
             kMostCopies * static_cast<double>(num_nodes) &&
         AreDisjoint(NodeRanges(blocks, 0)) &&
         AreDisjoint(NodeRanges(blocks, 1));
}

// Returns the ranges of the nodes that are in none of the disjoint ranges.
std::vector<NodeRange> Gaps(const std::vector<NodeRange>& ranges,
                            std::ptrdiff_t num_nodes) {
  std::vector<NodeRange> gaps;
  std::ptrdiff_t end = 0;
  for (const NodeRange& range : ranges) {
    gaps.push_back({end, range.first});
    end = range.end;
  }
  gaps.push_back({end, num_nodes});
  return gaps;
}

}  // namespace

ElementBlocks ChooseElementBlocks(const Mesh& mesh,
                                  std::ptrdiff_t smallest_block) {
  ElementBlocks chosen;
  chosen.blocks = BlocksOf(mesh, smallest_block);
  while (chosen.blocks.size() > 1 &&
         !AreSuitable(chosen.blocks, mesh.NumNodes())) {
    chosen.blocks = Merged(chosen.blocks);
  }
  for (const ElementBlock& block : chosen.blocks) {
    chosen.most_nodes = std::max(chosen.most_nodes, block.nodes.NumNodes());
  }
  chosen.gaps = Gaps(NodeRanges(chosen.blocks, 0), mesh.NumNodes());
  return chosen;
}

}  // namespace elastimate
