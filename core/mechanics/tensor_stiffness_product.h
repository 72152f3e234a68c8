#ifndef ELASTIMATE_CORE_MECHANICS_TENSOR_STIFFNESS_PRODUCT_H_
#define ELASTIMATE_CORE_MECHANICS_TENSOR_STIFFNESS_PRODUCT_H_

#include <Eigen/Core>

#include "elastimate/core/mechanics/quadratic_mesh.h"
#include "elastimate/core/mechanics/stiffness_product.h"

namespace elastimate {

/// Computes a = H q and b = J q on quadratic hexahedra or quadrilaterals with
/// straight edges, for each column q of `displacement`; all three are num_dofs
/// x num_columns.
///
/// The integrals are sums over three Gauss points along each axis.  A shape
/// function is a product of functions of one coordinate each, so values at all
/// points follow from those at the nodes along one axis after another, and
/// derivatives from the values at the three points of a line (sum factorisation
/// [Orszag, J. Comput. Phys. 37 (1980) 70]); forces follow by the transposed
/// steps.  The map of the element is that of its vertices.
///
/// The instructions are those of the processor that the program runs on: eight
/// (AVX-512), four (AVX2) elements or one at a time.  On one processor the
/// values of a column do not depend on the other columns.
/// Cost: one element pass.
void MultiplyTensorElements(const QuadraticMesh& mesh,
                            const Eigen::MatrixXd& displacement,
                            StiffnessProducts& products);

/// Returns the sum over the elements of c_0 H_e q + c_1 J_e q, with the
/// coefficients c of each element (2 x num_elements), for each column of
/// `displacement`.  It takes less time than both products.
Eigen::MatrixXd MultiplyTensorElements(const QuadraticMesh& mesh,
                                       const Eigen::Matrix2Xd& coefficients,
                                       const Eigen::MatrixXd& displacement);

}  // namespace elastimate

#endif  // ELASTIMATE_CORE_MECHANICS_TENSOR_STIFFNESS_PRODUCT_H_
