#ifndef ELASTIMATE_CORE_MESH_NODE_GRAPH_H_
#define ELASTIMATE_CORE_MESH_NODE_GRAPH_H_

#include <Eigen/Core>
#include <vector>

#include "elastimate/core/mesh/mesh.h"

namespace elastimate {

/// The pairs of nodes that share an element: the block pattern of the lower
/// triangle of any stiffness matrix of the mesh.
///
/// Pair k of node j, for k in [start[j], start[j + 1]), is (row[k], j) with
/// row[k] >= j, ascending; the first is (j, j).
struct NodeGraph {
  std::vector<Eigen::Index> start;  ///< num_nodes + 1.
  std::vector<int> row;             ///< num_pairs.
  /// The pair of each two of the n nodes of an element, (n (n + 1) / 2) x
  /// num_elements.  The pair of its nodes i and j is in row LocalPair(i, j).
  Eigen::MatrixXi element_pairs;

  /// O(num_elements) time and memory.
  explicit NodeGraph(const Mesh& mesh);

  Eigen::Index NumPairs() const { return Eigen::Index(row.size()); }

  /// Numbers the pairs (0, 0), (1, 0), (1, 1), (2, 0) and so on.
  static Eigen::Index LocalPair(Eigen::Index i, Eigen::Index j) {
    return i < j ? LocalPair(j, i) : i * (i + 1) / 2 + j;
  }
};

}  // namespace elastimate

#endif  // ELASTIMATE_CORE_MESH_NODE_GRAPH_H_
