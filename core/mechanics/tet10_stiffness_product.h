#ifndef ELASTIMATE_CORE_MECHANICS_TET10_STIFFNESS_PRODUCT_H_
#define ELASTIMATE_CORE_MECHANICS_TET10_STIFFNESS_PRODUCT_H_

#include <Eigen/Core>

#include "elastimate/core/mechanics/quadratic_mesh.h"
#include "elastimate/core/mechanics/stiffness_product.h"

namespace elastimate {

/// Computes a = H q and b = J q on quadratic tetrahedra with straight edges,
/// for each column q of `displacement`; all three are (3 num_nodes) x
/// num_columns.
///
/// Gradients are linear in an element.  With the gradients g_i of the
/// barycentric coordinates and the displacements w of the nodes less that of
/// vertex 0, of which w_vj is in the middle of the edge from v to j and
/// w_vv = w_v, the gradient at vertex v is
///
///   G_v = sum_j (4 w_vj - w_j) g_j^T.
///
/// Integrals of products with linear functions take the stresses S_v, here
/// sym(G_v) or tr(G_v) I, to
///
///   tau_v = (V / 20) (S_v + sum_w S_w),
///   f_v = 4 tau_v g_v - (sum_w tau_w) g_v,   f_vj = 4 (tau_v g_j + tau_j g_v).
///
/// The instructions are those of the processor that the program runs on: eight
/// (AVX-512), four (AVX2) elements or one at a time.  On one processor the
/// values of a column do not depend on the other columns.
/// Cost: one element pass, about four times that of linear tetrahedra.
void MultiplyQuadraticTetrahedra(const QuadraticMesh& mesh,
                                 const Eigen::MatrixXd& displacement,
                                 StiffnessProducts& products);

/// Returns the sum over the elements of c_0 H_e q + c_1 J_e q, with the
/// coefficients c of each element (2 x num_elements), for each column of
/// `displacement`.  It takes two thirds of the time of both products.
Eigen::MatrixXd MultiplyQuadraticTetrahedra(
    const QuadraticMesh& mesh, const Eigen::Matrix2Xd& coefficients,
    const Eigen::MatrixXd& displacement);

}  // namespace elastimate

#endif  // ELASTIMATE_CORE_MECHANICS_TET10_STIFFNESS_PRODUCT_H_
