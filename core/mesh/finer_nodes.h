#ifndef ELASTIMATE_CORE_MESH_FINER_NODES_H_
#define ELASTIMATE_CORE_MESH_FINER_NODES_H_

#include <Eigen/Core>
#include <Eigen/SparseCore>

#include "elastimate/core/mesh/mesh.h"

namespace elastimate {

/// The nodes that quadratic simplices of the nodes of a mesh (SimplicialMesh)
/// have behind these, in the middle of their edges, between the two meshes:
/// displacements and forces are num_dofs x n, row dimension * node + component.
///
/// The functions of simplices are among those of the finer ones, and so are
/// taken over as they are: linear ones by the mean of the ends of an edge,
/// quadratic ones by their values at the middle of edges of half the size, in
/// reference coordinates where they are curved.
/// Hexahedra and quadrilaterals are taken as the linear simplices of their
/// nodes.
class FinerNodes {
 public:
  /// `finer` are quadratic simplices of the nodes of `mesh`, as many for each
  /// of its elements, one after another.  O(num_elements).
  FinerNodes(const Mesh& mesh, const Mesh& finer);

  /// The nodes of the mesh come first, the others behind them.
  Eigen::Index NumNodes() const { return weights_.cols(); }
  Eigen::Index NumMidEdges() const { return weights_.rows(); }

  /// The displacements of the elements of the mesh, given at its nodes, at all
  /// nodes.
  Eigen::MatrixXd Interpolate(const Eigen::MatrixXd& at_nodes) const;

  /// The transpose: the forces on the nodes of the mesh that do the same work
  /// as `forces` on every displacement of its elements.
  Eigen::MatrixXd Restrict(const Eigen::MatrixXd& forces) const;

  using Weights = Eigen::SparseMatrix<double, Eigen::RowMajor, Eigen::Index>;
  /// The weights that the nodes of the mesh have at the mid-edge nodes:
  /// num_mid_edges x num_nodes.
  const Weights& WeightsOfNodes() const { return weights_; }

 private:
  int dimension_;
  Weights weights_;
};

}  // namespace elastimate

#endif  // ELASTIMATE_CORE_MESH_FINER_NODES_H_
