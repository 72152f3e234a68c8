#ifndef ELASTIMATE_CORE_MESH_NEAREST_POINTS_H_
#define ELASTIMATE_CORE_MESH_NEAREST_POINTS_H_

#include <Eigen/Core>
#include <array>
#include <vector>

#include "elastimate/core/algebra/eigen_abi.h"

namespace elastimate {

/// Returns the pairs of points of which one is among the `count` points that
/// are nearest to the other, each pair once, the lesser index first, ascending.
/// `positions` is dimension x n, finite.  O(n log n), by a tree of nanoflann.
[[nodiscard]] std::vector<std::array<Eigen::Index, 2>> NearestPairs(
    const Eigen::MatrixXd& positions, int count);

/// A point that is nearest to another.
struct NearestPoint {
  Eigen::Index index;
  double distance;  ///< [length]
};

/// Returns, for each of `others` (dimension x m), the nearest of `positions`
/// (dimension x n with n > 0); all have to be finite.  O((n + m) log n), by the
/// same tree.
[[nodiscard]] std::vector<NearestPoint> NearestPoints(
    const Eigen::MatrixXd& positions, const Eigen::MatrixXd& others);

}  // namespace elastimate

#endif  // ELASTIMATE_CORE_MESH_NEAREST_POINTS_H_
