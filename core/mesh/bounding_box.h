#ifndef ELASTIMATE_CORE_MESH_BOUNDING_BOX_H_
#define ELASTIMATE_CORE_MESH_BOUNDING_BOX_H_

#include <Eigen/Core>

namespace elastimate {

/// Returns the length of the diagonal of the bounding box of some positions
/// (dimension x n, n > 0).
inline double DiagonalOf(const Eigen::MatrixXd& positions) {
  return (positions.rowwise().maxCoeff() - positions.rowwise().minCoeff())
      .norm();
}

}  // namespace elastimate

#endif  // ELASTIMATE_CORE_MESH_BOUNDING_BOX_H_
