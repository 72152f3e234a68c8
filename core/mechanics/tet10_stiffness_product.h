#ifndef ELASTIMATE_CORE_MECHANICS_TET10_STIFFNESS_PRODUCT_H_
#define ELASTIMATE_CORE_MECHANICS_TET10_STIFFNESS_PRODUCT_H_

#include <Eigen/Core>

#include "elastimate/core/mesh/mesh.h"

namespace elastimate {

/// On quadratic tetrahedra, adds the integrals of e grad(N_i) to `a` and of
/// tr(e) grad(N_i) to `p`, for each column of `displacement`; all three are
/// (3 num_nodes) x num_columns.
///
/// The strain e is linear in an element, and so is grad(N_i): with the strains
/// E_a at the vertices, their mean E, and T_a = (V / 5)(4 E + E_a),
///
///   a_a = (T_a - V E) g_a,   a_ab = T_a g_b + T_b g_a,
///
/// with g_a the gradient of the barycentric coordinate a.
/// Cost: one element pass, O(num_elements * num_columns).
void AddQuadraticStrainProducts(const Mesh& mesh,
                                const Eigen::MatrixXd& displacement,
                                Eigen::MatrixXd& a, Eigen::MatrixXd& p);

}  // namespace elastimate

#endif  // ELASTIMATE_CORE_MECHANICS_TET10_STIFFNESS_PRODUCT_H_
