#ifndef ELASTIMATE_BENCHMARKS_NAIVE_STIFFNESS_PRODUCT_H_
#define ELASTIMATE_BENCHMARKS_NAIVE_STIFFNESS_PRODUCT_H_

#include <Eigen/Core>

#include "elastimate/core/mechanics/stiffness_product.h"
#include "elastimate/core/mesh/mesh.h"

namespace elastimate {

/// What MultiplyStiffnessBasis is compared with: a = H q and b = J q as the
/// textbook writes them,
///
///   H_e = V B^T D_H B,   J_e = V B^T D_J B,
///
/// with the 6 x 12 matrix B from the inverse of the matrix of nodal
/// coordinates, and the two 12 x 12 element matrices formed, multiplied by the
/// element's displacements and added up.  Fixed-size Eigen matrices, no memory
/// allocated per element.
///
/// `displacement` is 3 num_nodes values, row 3 * node + component.
StiffnessProducts MultiplyNaively(const Mesh& mesh,
                                  const Eigen::VectorXd& displacement);

}  // namespace elastimate

#endif  // ELASTIMATE_BENCHMARKS_NAIVE_STIFFNESS_PRODUCT_H_
