#ifndef ELASTIMATE_CORE_STIFFNESS_PRODUCT_H_
#define ELASTIMATE_CORE_STIFFNESS_PRODUCT_H_

#include <Eigen/Core>

#include "elastimate/core/mesh.h"

namespace elastimate {

/// The products of the stiffness bases with some displacement columns.
struct StiffnessProducts {
  Eigen::MatrixXd h;  ///< a = H q, same shape as q.
  Eigen::MatrixXd j;  ///< b = J q, same shape as q.
};

/// a = H q and b = J q in one pass over the elements, for the stiffness bases
/// of K = s (H + nu J) [Becker & Teschner 2007, eq. 14-22].
///
/// `displacement` is (3 num_nodes) x num_columns, row 3 * node + component
/// [length]; the products have its shape.  With the strain tensor
/// e = sym(sum_i q_i grad(N_i)^T),
///
///   a_i = integral of e grad(N_i),
///   b_i = integral of tr(e) grad(N_i) - 2 a_i,
///
/// so that no element matrix is formed.  In a linear tetrahedron both factors
/// are constant, in a quadratic one both are linear, and the integrals exact.
///
/// Precondition: a valid mesh (ValidateMesh) and 3 num_nodes rows.
/// Cost: one element pass, O(num_elements * num_columns) time (for quadratic
/// tetrahedra about nine times that for linear ones), no memory beyond the
/// result.  Single-threaded; the same input gives the same bits.
StiffnessProducts MultiplyStiffnessBasis(const Mesh& mesh,
                                         const Eigen::MatrixXd& displacement);

}  // namespace elastimate

#endif  // ELASTIMATE_CORE_STIFFNESS_PRODUCT_H_
