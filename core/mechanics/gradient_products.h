#ifndef ELASTIMATE_CORE_MECHANICS_GRADIENT_PRODUCTS_H_
#define ELASTIMATE_CORE_MECHANICS_GRADIENT_PRODUCTS_H_

#include <Eigen/Core>

#include "elastimate/core/mesh/mesh.h"
#include "elastimate/core/mesh/node_graph.h"

namespace elastimate {

/// M_ij = integral of grad(N_i) grad(N_j)^T for each pair of the graph
/// [length]: 3 x 3 blocks side by side, above a row of zeros for columns that
/// are loaded whole, 4 x (3 num_pairs).  Every isotropic stiffness block
/// follows from it:
///
///   H_ij = (M_ij^T + tr(M_ij) I) / 2,   J_ij = M_ij - M_ij^T - tr(M_ij) I.
///
/// Exact for linear and for quadratic tetrahedra.
/// Cost: one element pass.
Eigen::Matrix4Xd GradientProducts(const Mesh& mesh, const NodeGraph& graph);

/// A pair_mask that keeps every pair.
constexpr Eigen::Index kEveryPair = -1;

/// Adds what the elements from `first` to before `end` contribute to M.  The
/// block of pair k is number k & pair_mask, so that memory for the pairs of a
/// front of nodes is enough where the rest is done with.
void AddGradientProducts(const Mesh& mesh, const NodeGraph& graph,
                         Eigen::Index first, Eigen::Index end,
                         Eigen::Index pair_mask, Eigen::Matrix4Xd& products);

/// H_ij from M_ij.
inline Eigen::Matrix3d StiffnessBlockH(const Eigen::Matrix3d& m) {
  return 0.5 * (m.transpose() + m.trace() * Eigen::Matrix3d::Identity());
}

/// J_ij from M_ij.
inline Eigen::Matrix3d StiffnessBlockJ(const Eigen::Matrix3d& m) {
  return m - m.transpose() - m.trace() * Eigen::Matrix3d::Identity();
}

}  // namespace elastimate

#endif  // ELASTIMATE_CORE_MECHANICS_GRADIENT_PRODUCTS_H_
