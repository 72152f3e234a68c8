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

/// Returns the places that a camera lost, as opposed to a hole of the specimen:
/// where a grid along the axes has no point in gaps of up to four places, and
/// in rows and columns, up to four side by side, that are missing over the
/// whole width.  2 x n; none where the points are not on a grid.  O(n log n).
Eigen::Matrix2Xd LostPoints(const Eigen::Matrix2Xd& positions);

}  // namespace elastimate

#endif  // ELASTIMATE_IO_DIC_POINT_MESH_H_
