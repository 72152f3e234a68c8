#ifndef ELASTIMATE_BENCHMARKS_NAIVE_STIFFNESS_PRODUCT_H_
#define ELASTIMATE_BENCHMARKS_NAIVE_STIFFNESS_PRODUCT_H_

#include <Eigen/Core>

#include "elastimate/core/mechanics/stiffness_product.h"
#include "elastimate/core/mesh/mesh.h"

namespace elastimate {

/// What MultiplyStiffnessBasis is compared with: a = H q and b = J q as the
/// textbook writes them,
///
///   H_e = sum of V B^T D_H B,   J_e = sum of V B^T D_J B
///
/// over the integration points, with the matrix B of strains formed there, and
/// the two element matrices formed, multiplied by the element's displacements
/// and added up.  Fixed-size Eigen matrices, no memory allocated per element.
///
/// `displacement` is num_dofs values, row dimension * node + component.
StiffnessProducts MultiplyNaively(const Mesh& mesh,
                                  const Eigen::VectorXd& displacement);

}  // namespace elastimate

#endif  // ELASTIMATE_BENCHMARKS_NAIVE_STIFFNESS_PRODUCT_H_
