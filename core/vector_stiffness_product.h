#ifndef ELASTIMATE_CORE_VECTOR_STIFFNESS_PRODUCT_H_
#define ELASTIMATE_CORE_VECTOR_STIFFNESS_PRODUCT_H_

#include <Eigen/Core>

#include "elastimate/core/mesh.h"

namespace elastimate {

/// Adds V e grad(N_i) and V tr(e) grad(N_i) of the displacement columns to `a`
/// and `p`, as MultiplyStiffnessBasis does, for the first linear tetrahedra of
/// a mesh: those that fill batches of 8 or 4, by vector instructions of the
/// processor that the program runs on (AVX-512, AVX2).  Returns their number:
/// zero on other processors.
///
/// Each node has its position and its displacements side by side, in fours that
/// are loaded whole and transposed in registers, and so have its sums.
Eigen::Index AddVectorStrainProducts(const Mesh& mesh,
                                     const Eigen::MatrixXd& displacement,
                                     Eigen::MatrixXd& a, Eigen::MatrixXd& p);

}  // namespace elastimate

#endif  // ELASTIMATE_CORE_VECTOR_STIFFNESS_PRODUCT_H_
