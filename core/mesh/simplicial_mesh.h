#ifndef ELASTIMATE_CORE_MESH_SIMPLICIAL_MESH_H_
#define ELASTIMATE_CORE_MESH_SIMPLICIAL_MESH_H_

#include <Eigen/Core>

#include "elastimate/core/mesh/mesh.h"
#include "elastimate/core/mesh/mesh_points.h"

namespace elastimate {

/// The body of a mesh as linear tetrahedra or triangles of the same nodes.
///
/// A quadratic simplex is cut at the middle of its edges into eight or four, of
/// equal volume if its edges are straight, of a tetrahedron along the shortest
/// diagonal inside; a curved one is replaced by simplices that are not.  A
/// hexahedron is cut into six and a quadrilateral into two, each face along the
/// diagonal from its first node, so that neighbours meet [Dompierre et al.,
/// Proc. 8th Int. Meshing Roundtable (1999)].  First are every other node along
/// the edges, as far as there is such a colouring, so that diagonals alternate
/// and the simplices are no stiffer one way than the other.  Linear simplices
/// stay what they are.
///
/// A hexahedron whose faces are far from flat may become tetrahedra that
/// overlap, which this does not look for.
class SimplicialMesh {
 public:
  /// Precondition: a valid mesh, which outlives this; a temporary one does not
  /// compile.  O(num_elements).
  explicit SimplicialMesh(const Mesh& mesh);
  explicit SimplicialMesh(const Mesh&&) = delete;

  /// Each element has as many, one element after another, in its region.
  const Mesh& Simplices() const { return simplices_; }

  /// The faces of the simplices that facets of the mesh become, in their order
  /// and the same way round: 3 x n, in two dimensions 2 x n.  O(num_facets).
  Eigen::MatrixXi FacetsOf(const Eigen::MatrixXi& facets) const;

  /// Returns points of the mesh as points of the simplices.  In simplices they
  /// keep their reference coordinates, in other elements their place.  A point
  /// that lies in no simplex, as beside a face that is not flat, is put on the
  /// face of the nearest one.
  /// Precondition: ValidatePoints.  O(n).
  MeshPoints PointsOf(const MeshPoints& points) const;

 private:
  const Mesh& mesh_;
  /// The order of the nodes in which diagonals begin; empty for simplices.
  Eigen::VectorXi rank_;
  Mesh simplices_;
};

}  // namespace elastimate

#endif  // ELASTIMATE_CORE_MESH_SIMPLICIAL_MESH_H_
