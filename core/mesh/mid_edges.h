#ifndef ELASTIMATE_CORE_MESH_MID_EDGES_H_
#define ELASTIMATE_CORE_MESH_MID_EDGES_H_

#include <Eigen/Core>

#include "elastimate/core/mesh/mesh.h"

namespace elastimate {

/// The nodes in the middle of the edges of a quadratic mesh.  This carries
/// forces from the mesh to linear elements of its vertices: num_dofs x n, row
/// dimension * node + component.
class MidEdges {
 public:
  /// Precondition: a valid mesh; one of order 1 has none.  O(num_elements).
  explicit MidEdges(const Mesh& mesh);

  /// 2 x num_mid_edges vertices, those of node num_vertices + i in column i.
  const Eigen::Matrix2Xi& Ends() const { return ends_; }
  Eigen::Index NumVertices() const { return num_vertices_; }

  /// Returns the forces on the vertices that do the same work as `forces` on
  /// every displacement which is linear in each element: f_a plus half of each
  /// f_ab.  They have the same resultant and moment.
  Eigen::MatrixXd Restrict(const Eigen::MatrixXd& forces) const;

 private:
  int dimension_;
  Eigen::Index num_vertices_;
  Eigen::Matrix2Xi ends_;
};

}  // namespace elastimate

#endif  // ELASTIMATE_CORE_MESH_MID_EDGES_H_
