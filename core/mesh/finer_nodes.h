#ifndef ELASTIMATE_CORE_MESH_FINER_NODES_H_
#define ELASTIMATE_CORE_MESH_FINER_NODES_H_

#include <Eigen/Core>
#include <Eigen/SparseCore>

#include "elastimate/core/mesh/mesh.h"

namespace elastimate {

/// Quadratic elements of the nodes of a mesh (LinearMesh) have further nodes in
/// the middle of their vertices, which come behind the nodes of the mesh.  This
/// carries displacements and forces between the two meshes.  Both are num_dofs
/// x n, row dimension * node + component.
///
/// The functions of the elements are among those of the finer ones, and so are
/// taken over as they are.  A linear (bilinear, trilinear) function has the
/// mean of the vertices in their middle.  A quadratic function has its own
/// values at the middles of elements of half the size, in reference coordinates
/// where elements are curved.
class FinerNodes {
 public:
  /// `finer` has quadratic elements of the nodes of `mesh`, the same number
  /// for each element of `mesh`, one element after another.  O(num_elements).
  FinerNodes(const Mesh& mesh, const Mesh& finer);

  /// Returns the number of nodes of the mesh, behind which the middle nodes
  /// come.
  Eigen::Index NumNodes() const { return weights_.cols(); }
  Eigen::Index NumMiddles() const { return weights_.rows(); }

  /// Returns the displacements, at all nodes, of the elements of the mesh whose
  /// nodes are displaced by `at_nodes`.
  Eigen::MatrixXd Interpolate(const Eigen::MatrixXd& at_nodes) const;

  /// Multiplies by the transpose of Interpolate.  The result is the forces on
  /// the nodes of the mesh that do the same work as `forces` on every
  /// displacement of its elements.
  Eigen::MatrixXd Restrict(const Eigen::MatrixXd& forces) const;

  using Weights = Eigen::SparseMatrix<double, Eigen::RowMajor>;
  /// Returns the weights of the nodes of the mesh at the middle nodes,
  /// num_middles x num_nodes.
  const Weights& WeightsOfNodes() const { return weights_; }

 private:
  int dimension_;
  Weights weights_;
};

}  // namespace elastimate

#endif  // ELASTIMATE_CORE_MESH_FINER_NODES_H_
