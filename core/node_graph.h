#ifndef ELASTIMATE_CORE_NODE_GRAPH_H_
#define ELASTIMATE_CORE_NODE_GRAPH_H_

#include <Eigen/Core>
#include <vector>

#include "elastimate/core/mesh.h"

namespace elastimate {

/// Which pairs of nodes share an element: the block pattern of the lower
/// triangle of any stiffness matrix of the mesh.
///
/// Pair k of node j, for k in [start[j], start[j + 1]), is (row[k], j) with
/// row[k] >= j, ascending; the first is (j, j).
struct NodeGraph {
  std::vector<Eigen::Index> start;  ///< num_nodes + 1.
  std::vector<int> row;             ///< num_pairs.
  /// The pair of each two nodes of an element, (nodes_per_element^2) x
  /// num_elements: row i * nodes_per_element + j is the pair of local nodes i
  /// and j when node i >= node j, and -1 otherwise.
  Eigen::MatrixXi element_pairs;

  /// O(num_elements) time and memory.
  explicit NodeGraph(const Mesh& mesh);

  Eigen::Index NumPairs() const { return Eigen::Index(row.size()); }
};

/// M_ij = integral of grad(N_i) grad(N_j)^T for each pair of the graph, 3 x 3
/// blocks side by side: 3 x (3 num_pairs) [length].  Every isotropic stiffness
/// block follows from it:
///
///   H_ij = (M_ij^T + tr(M_ij) I) / 2,   J_ij = M_ij - M_ij^T - tr(M_ij) I.
///
/// Exact for linear and for quadratic tetrahedra.
/// Cost: one element pass.
Eigen::Matrix3Xd GradientProducts(const Mesh& mesh, const NodeGraph& graph);

/// A pair_mask that keeps every pair.
constexpr Eigen::Index kEveryPair = -1;

/// Adds what the elements from `first` to before `end` contribute to M.  The
/// block of pair k is number k & pair_mask, so that memory for the pairs of a
/// front of nodes is enough where the rest is done with.
void AddGradientProducts(const Mesh& mesh, const NodeGraph& graph,
                         Eigen::Index first, Eigen::Index end,
                         Eigen::Index pair_mask, Eigen::Matrix3Xd& products);

/// H_ij from M_ij.
inline Eigen::Matrix3d StiffnessBlockH(const Eigen::Matrix3d& m) {
  return 0.5 * (m.transpose() + m.trace() * Eigen::Matrix3d::Identity());
}

/// J_ij from M_ij.
inline Eigen::Matrix3d StiffnessBlockJ(const Eigen::Matrix3d& m) {
  return m - m.transpose() - m.trace() * Eigen::Matrix3d::Identity();
}

}  // namespace elastimate

#endif  // ELASTIMATE_CORE_NODE_GRAPH_H_
