#ifndef ELASTIMATE_CORE_MECHANICS_GRADIENT_PRODUCTS_H_
#define ELASTIMATE_CORE_MECHANICS_GRADIENT_PRODUCTS_H_

#include <Eigen/Core>

#include "elastimate/core/laws/elasticity.h"
#include "elastimate/core/mesh/mesh.h"
#include "elastimate/core/mesh/node_graph.h"

namespace elastimate {

/// M_ij = integral of grad(N_i) grad(N_j)^T for each pair of the graph [length;
/// of a planar mesh with its thickness]: dimension x dimension blocks side by
/// side, in three dimensions above a row of zeros for columns that are loaded
/// whole: ProductRows(dimension) x (dimension num_pairs).  Every isotropic
/// stiffness block follows from it:
///
///   H_ij = (M_ij^T + tr(M_ij) I) / 2,   J_ij = M_ij - c H_ij
///
/// with c of ShearShareOfJ.  Exact for straight-sided simplices.
/// Cost: one element pass.
Eigen::MatrixXd GradientProducts(const Mesh& mesh, const NodeGraph& graph);

constexpr Eigen::Index ProductRows(int dimension) {
  return dimension == 3 ? 4 : 2;
}

/// This pair_mask keeps every pair.
constexpr Eigen::Index kEveryPair = -1;

/// Adds what the elements from `first` to before `end` contribute to M.  The
/// block of pair k is number k & pair_mask, so that memory for the pairs of a
/// front of nodes is enough where the rest is done with.
void AddGradientProducts(const Mesh& mesh, const NodeGraph& graph,
                         Eigen::Index first, Eigen::Index end,
                         Eigen::Index pair_mask, Eigen::MatrixXd& products);

/// A block of M, H or J.
template <int kDimension>
using NodeBlock = Eigen::Matrix<double, kDimension, kDimension>;

/// Returns H_ij from M_ij.
template <int kDimension>
NodeBlock<kDimension> StiffnessBlockH(const NodeBlock<kDimension>& m) {
  return 0.5 * (m.transpose() + m.trace() * NodeBlock<kDimension>::Identity());
}

/// Returns J_ij from M_ij, where `c` is ShearShareOfJ.
template <int kDimension>
NodeBlock<kDimension> StiffnessBlockJ(const NodeBlock<kDimension>& m,
                                      double c) {
  return m -
         c / 2 *
             (m.transpose() + m.trace() * NodeBlock<kDimension>::Identity());
}

}  // namespace elastimate

#endif  // ELASTIMATE_CORE_MECHANICS_GRADIENT_PRODUCTS_H_
