#ifndef ELASTIMATE_CORE_MECHANICS_ELEMENT_STIFFNESS_PRODUCT_H_
#define ELASTIMATE_CORE_MECHANICS_ELEMENT_STIFFNESS_PRODUCT_H_

#include <Eigen/Core>

#include "elastimate/core/mesh/mesh.h"

namespace elastimate {

/// Adds, for each column u of `displacement` and elements of any kind, at their
/// StiffnessRule,
///
///   a_i = integral of e grad(N_i),   p_i = integral of tr(e) grad(N_i),
///
/// with e = sym(grad u).  All matrices are num_dofs x num_columns.  No element
/// matrix is formed; for a hexahedron, that takes a tenth of the operations.
void AddStrainProducts(const Mesh& mesh, const Eigen::MatrixXd& displacement,
                       Eigen::MatrixXd& a, Eigen::MatrixXd& p);

}  // namespace elastimate

#endif  // ELASTIMATE_CORE_MECHANICS_ELEMENT_STIFFNESS_PRODUCT_H_
