#ifndef ELASTIMATE_CORE_MECHANICS_TET4_POINT_FORCES_H_
#define ELASTIMATE_CORE_MECHANICS_TET4_POINT_FORCES_H_

#include <Eigen/Core>
#include <cstdint>

#include "elastimate/core/large_strain/large_strain_law.h"
#include "elastimate/core/mesh/mesh.h"
#include "elastimate/core/mesh/node_graph.h"

namespace elastimate {

/// Some linear tetrahedra, whose gradients and forces are computed several at
/// once by vector instructions.
///
///   H = sum_i u_i grad(N_i)^T,   f_i = V P grad(N_i)
class Tet4Points {
 public:
  static constexpr int kElements = PointMatrices::kPoints;

  /// Takes `count` elements, at most kElements, of a mesh of linear tetrahedra.
  /// `elements` is not copied, and has to outlive this object.
  Tet4Points(const Mesh& mesh, const Eigen::Index* elements, int count);

  int NumPoints() const { return count_; }

  /// Sets `gradients` to H of each element.
  void SetGradients(const double* displacement, PointMatrices& gradients) const;

  /// Adds the forces of these stresses to those of the nodes, num_dofs.
  void AddForces(const PointMatrices& stresses, double* forces) const;

  /// Adds V grad(N_i) . A . grad(N_j) for these tangents A to the blocks of the
  /// pairs of the graph, 3 x (3 num_pairs).
  void AddBlocks(const PointTangents& tangents, const NodeGraph& graph,
                 Eigen::MatrixXd& blocks) const;

 private:
  int count_;
  const Eigen::Index* elements_;
  /// The first degree of freedom of each corner of each element.
  alignas(64) std::int64_t row_[4][PointMatrices::kPoints];
  PointMatrices gradients_;  ///< grad(N_i), i = 1, 2, 3, as columns.
  PointValues<1> volumes_;
};

}  // namespace elastimate

#endif  // ELASTIMATE_CORE_MECHANICS_TET4_POINT_FORCES_H_
