#ifndef ELASTIMATE_IO_DIC_POINT_MESH_H_
#define ELASTIMATE_IO_DIC_POINT_MESH_H_

#include <Eigen/Core>
#include <optional>
#include <vector>

#include "elastimate/core/mesh/element_kind.h"

namespace elastimate {

/// A planar mesh whose nodes are measured points.
struct PointMesh {
  ElementKind kind = ElementKind::kTri3;
  std::vector<Eigen::Index> points;  ///< The point of each node, ascending.
  Eigen::MatrixXi elements;          ///< Places of nodes, counterclockwise.
  double max_edge = 0;               ///< As given, or as found.
};

/// Makes quadrilaterals where the points form a grid along the axes, else
/// Delaunay triangles (by VTK) without slivers of the rim.  Elements with an
/// edge above `max_edge` are left out; without `max_edge`, the limit is 1.5
/// times the length below which nine of ten edges are.  Holes and gaps stay
/// what they are.  The largest part is taken where parts are not connected.
/// Throws std::invalid_argument where that leaves no element.
/// O(n log n).
PointMesh MeshOfPoints(const Eigen::Matrix2Xd& positions,
                       std::optional<double> max_edge);

/// Places of a grid without a point, 2 x n each.
struct GridGaps {
  /// Places that the camera lost: gaps of one or two places, and rows and
  /// columns, up to four side by side, that are missing over the whole width.
  Eigen::Matrix2Xd lost;
  /// Larger gaps within the box of the grid, where either the camera lost
  /// points or the specimen has a hole, a slot or a notch; the largest first.
  std::vector<Eigen::Matrix2Xd> doubtful;
};

/// Finds the gaps of points on a grid along the axes; none where the points are
/// on no grid.  A gap of more than half as many places as there are points is
/// no gap, but beside the specimen.  O(n log n).
GridGaps GapsOf(const Eigen::Matrix2Xd& positions);

}  // namespace elastimate

#endif  // ELASTIMATE_IO_DIC_POINT_MESH_H_
