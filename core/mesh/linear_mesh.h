#ifndef ELASTIMATE_CORE_MESH_LINEAR_MESH_H_
#define ELASTIMATE_CORE_MESH_LINEAR_MESH_H_

#include <Eigen/Core>

#include "elastimate/core/mesh/mesh.h"
#include "elastimate/core/mesh/mesh_points.h"

namespace elastimate {

/// Models a body of any elements as linear elements of the same nodes.  Linear
/// elements stay what they are.
///
/// Quadratic elements are divided at their middle nodes: a tetrahedron, along
/// its shortest inner diagonal, and a hexahedron into eight parts, a triangle
/// and a quadrilateral into four.  Where edges are straight, the parts fill the
/// element, and their maps are its map; a curved element is replaced by
/// simplices that are not curved.
class LinearMesh {
 public:
  /// Precondition: a valid mesh, which outlives this; a temporary one does not
  /// compile.  O(num_elements).
  explicit LinearMesh(const Mesh& mesh);
  explicit LinearMesh(const Mesh&&) = delete;

  /// Returns the linear elements, the same number for each element, one element
  /// after another, with the region of the element.
  const Mesh& Parts() const { return parts_; }

  /// Returns the facets of the parts that facets of the mesh become, in the
  /// order and with the orientation of the facets.  O(num_facets).
  Eigen::MatrixXi FacetsOf(const Eigen::MatrixXi& facets) const;

  /// Returns the same points in the parts, at the same reference coordinates of
  /// the element that was divided.
  /// Precondition: ValidatePoints.  O(n).
  MeshPoints PointsOf(const MeshPoints& points) const;

 private:
  const Mesh& mesh_;
  Mesh parts_;
};

}  // namespace elastimate

#endif  // ELASTIMATE_CORE_MESH_LINEAR_MESH_H_
