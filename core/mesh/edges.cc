#include "elastimate/core/mesh/edges.h"

#include <algorithm>

namespace elastimate {
namespace {

// Each node up to `low` has one pair with itself in the graph, which is no
// edge.
Eigen::Index EdgeOfPair(int low, Eigen::Index pair) { return pair - low - 1; }

}  // namespace

Edges::Edges(const Mesh& mesh) : graph_(mesh) {
  ends_.resize(2, graph_.NumPairs() - mesh.NumNodes());
  for (int low = 0; low < mesh.NumNodes(); ++low) {
    for (Eigen::Index pair = graph_.start[low] + 1;
         pair < graph_.start[low + 1]; ++pair) {
      ends_.col(EdgeOfPair(low, pair)) << low, graph_.row[pair];
    }
  }
}

Eigen::Index Edges::Find(int a, int b) const {
  const auto [low, high] = std::minmax(a, b);
  const auto first = graph_.row.begin() + graph_.start[low];
  const auto last = graph_.row.begin() + graph_.start[low + 1];
  const auto found = std::lower_bound(first, last, high);
  return low == high || found == last || *found != high
             ? -1
             : EdgeOfPair(low, found - graph_.row.begin());
}

}  // namespace elastimate
