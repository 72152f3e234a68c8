#ifndef ELASTIMATE_CORE_MESH_MIDDLE_NODES_H_
#define ELASTIMATE_CORE_MESH_MIDDLE_NODES_H_

#include <Eigen/Core>

#include "elastimate/core/mesh/mesh.h"
#include "elastimate/core/mesh/vertex_lists.h"

namespace elastimate {

/// The nodes in the middle of the edges, faces and elements of a quadratic
/// mesh.  This carries forces from the mesh to linear elements of its vertices:
/// num_dofs x n, row dimension * node + component.
class MiddleNodes {
 public:
  /// Precondition: a valid mesh; one of order 1 has none.  O(num_elements).
  explicit MiddleNodes(const Mesh& mesh);

  /// Returns the vertices that node num_vertices + i is in the middle of.
  const VertexLists& Vertices() const { return vertices_; }
  Eigen::Index NumVertices() const { return num_vertices_; }

  /// Returns the forces on the vertices that do the same work as `forces` on
  /// every displacement which is linear (bilinear, trilinear) in each element:
  /// each vertex gets an equal share of the force on the middle.  They have the
  /// same resultant and moment.
  Eigen::MatrixXd Restrict(const Eigen::MatrixXd& forces) const;

 private:
  int dimension_;
  Eigen::Index num_vertices_;
  VertexLists vertices_;
};

}  // namespace elastimate

#endif  // ELASTIMATE_CORE_MESH_MIDDLE_NODES_H_
