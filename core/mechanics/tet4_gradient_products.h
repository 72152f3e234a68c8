#ifndef ELASTIMATE_CORE_MECHANICS_TET4_GRADIENT_PRODUCTS_H_
#define ELASTIMATE_CORE_MECHANICS_TET4_GRADIENT_PRODUCTS_H_

#include <Eigen/Core>

#include "elastimate/core/mesh/mesh.h"
#include "elastimate/core/mesh/node_graph.h"

namespace elastimate {

/// Does what AddGradientProducts does, on linear tetrahedra.  With the edges
/// e_i = x_i - x_0 and the cofactors c_1 = e_2 x e_3 (and so on), c_0 = -(c_1 +
/// c_2 + c_3), an element adds
///
///   V grad(N_i) grad(N_j)^T = c_i c_j^T / (6 |det J|).
///
/// The instructions are those of the processor that the program runs on.
void AddLinearGradientProducts(const Mesh& mesh, const NodeGraph& graph,
                               Eigen::Index first, Eigen::Index end,
                               Eigen::Index pair_mask,
                               Eigen::MatrixXd& products);

}  // namespace elastimate

#endif  // ELASTIMATE_CORE_MECHANICS_TET4_GRADIENT_PRODUCTS_H_
