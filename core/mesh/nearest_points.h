#ifndef ELASTIMATE_CORE_MESH_NEAREST_POINTS_H_
#define ELASTIMATE_CORE_MESH_NEAREST_POINTS_H_

#include <Eigen/Core>
#include <array>
#include <vector>

namespace elastimate {

/// The pairs of points of which one is among the `count` points that are
/// nearest to the other, each pair once, the lesser index first, ascending.
/// `positions` is dimension x n, finite.  O(n log n), by a tree of nanoflann.
std::vector<std::array<Eigen::Index, 2>> NearestPairs(
    const Eigen::MatrixXd& positions, int count);

}  // namespace elastimate

#endif  // ELASTIMATE_CORE_MESH_NEAREST_POINTS_H_
