#ifndef ELASTIMATE_CORE_MESH_SIMPLICIAL_MESH_H_
#define ELASTIMATE_CORE_MESH_SIMPLICIAL_MESH_H_

#include <Eigen/Core>

#include "elastimate/core/mesh/mesh.h"
#include "elastimate/core/mesh/mesh_points.h"

namespace elastimate {

/// Models a body of any elements as linear tetrahedra or triangles of the same
/// nodes.  Linear simplices stay what they are.
///
/// A quadratic tetrahedron is cut at the middle of its edges into eight
/// simplices, along its shortest inner diagonal, and a quadratic triangle into
/// four.  They have equal volume if its edges are straight; a curved element is
/// replaced by simplices that are not curved.  A hexahedron is cut into six
/// tetrahedra and a quadrilateral into two triangles, each face along the
/// diagonal from its first node, so that neighbours meet [Dompierre et al.,
/// Proc. 8th Int. Meshing Roundtable (1999)].  First nodes are every other node
/// along the edges, as far as there is such a colouring, so that diagonals
/// alternate and the simplices are no stiffer one way than the other.
///
/// A hexahedron whose faces are far from flat may become tetrahedra that
/// overlap, which this does not look for.
class SimplicialMesh {
 public:
  /// Precondition: a valid mesh, which outlives this; a temporary one does not
  /// compile.  O(num_elements).
  explicit SimplicialMesh(const Mesh& mesh);
  explicit SimplicialMesh(const Mesh&&) = delete;

  /// Returns the simplices, the same number for each element, one element after
  /// another, with the region of the element.
  const Mesh& Simplices() const { return simplices_; }

  /// Returns the faces of the simplices that facets of the mesh become, in the
  /// order and with the orientation of the facets: 3 x n, in two dimensions 2 x
  /// n.  O(num_facets).
  Eigen::MatrixXi FacetsOf(const Eigen::MatrixXi& facets) const;

  /// Returns the same points in the simplices.  A point of a simplex keeps its
  /// reference coordinates; another point keeps its place.  A point that lies
  /// between two simplices, as beside a face that is not flat, moves to the
  /// face of the nearest.
  /// Precondition: ValidatePoints.  O(n).
  MeshPoints PointsOf(const MeshPoints& points) const;

 private:
  const Mesh& mesh_;
  /// The rank of each node, by which diagonals begin; empty for simplices.
  Eigen::VectorXi rank_;
  Mesh simplices_;
};

}  // namespace elastimate

#endif  // ELASTIMATE_CORE_MESH_SIMPLICIAL_MESH_H_
