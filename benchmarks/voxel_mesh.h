#ifndef ELASTIMATE_BENCHMARKS_VOXEL_MESH_H_
#define ELASTIMATE_BENCHMARKS_VOXEL_MESH_H_

#include <Eigen/Core>
#include <functional>

#include "elastimate/core/mesh/mesh.h"

namespace elastimate {

/// A body of voxels: those cells of a grid that are kept, their corners moved
/// by a map.  Points of the grid are counted in cells, from 0 to `cells`.
struct VoxelBody {
  Eigen::Vector3i cells;
  /// Whether the cell with this centre belongs to the body.
  std::function<bool(const Eigen::Vector3d&)> keeps;
  /// Where a point of the grid lies [length].
  std::function<Eigen::Vector3d(const Eigen::Vector3d&)> position;
  /// Whether the grid closes along its first axis, like an angle, of which
  /// `position` then has the period; at least three cells.
  bool is_ring = false;
};

/// A mesh of such a body.
struct VoxelMesh {
  Mesh mesh;
  Eigen::Matrix3Xd grid;  ///< The points of the grid of the nodes.
};

/// Each voxel cut into six linear tetrahedra around its diagonal.
/// O(number of cells of the grid).
VoxelMesh TetrahedralMesh(const VoxelBody& body);

/// Each voxel cut into parts^3 trilinear hexahedra; the first nodes are those
/// of TetrahedralMesh.  Precondition: positive.  O(the same times parts^3).
VoxelMesh HexahedralMesh(const VoxelBody& body, int parts);

}  // namespace elastimate

#endif  // ELASTIMATE_BENCHMARKS_VOXEL_MESH_H_
