#ifndef ELASTIMATE_CORE_SCENE_UNKNOWN_MOTION_H_
#define ELASTIMATE_CORE_SCENE_UNKNOWN_MOTION_H_

#include <Eigen/Core>
#include <Eigen/SparseCore>

#include "elastimate/core/scene/scene.h"

namespace elastimate {

/// Whether displacements of supports, or of the whole specimen, are not known,
/// or forces of supports were measured.  O(1).
[[nodiscard]] bool HasUnknownMotion(const Scene& scene);

/// The part of ValidateScene about unknown displacements of supports and about
/// resultants.  O(num_dofs num_load_cases).
void ValidateUnknownMotion(const Scene& scene);

/// The held components that moved as measured: those of unknown displacement
/// that are not in rigid faces.  dimension x num_nodes; empty when there are
/// none of unknown displacement.
[[nodiscard]] ComponentMask AsMeasured(const Supports& supports);

/// What moved by unknown amounts b and a in a load case,
///
///   u of the supports = given + G b,   what was measured = u + R a + noise.
///
/// Amounts are lengths.  Nodes that a refinement put into supports that moved
/// as measured (Supports::middles), and mid-edge nodes of a mesh of order 2
/// there, move as the mean of the two nodes at their ends where they were
/// measured in no load case of these supports.
struct UnknownMotion {
  /// G: num_dofs x n.  One column for each displacement that is as measured,
  /// and the rigid motions of each face, three to six at most.
  Eigen::SparseMatrix<double> of_supports;
  /// R: num_dofs x 3 or 6, where a rigid motion of all is free, else x 0.
  Eigen::MatrixXd of_all;

  /// In the load cases of these supports of the scene.  Precondition: a valid
  /// scene.  O(num_dofs num_load_cases).
  UnknownMotion(const Scene& scene, const Supports& supports);

  /// How many amounts there are in a load case.
  Eigen::Index NumAmounts() const { return of_supports.cols() + of_all.cols(); }
};

/// The displacement of AsMeasured as measured in load case `k`, zero elsewhere
/// and where a node was not measured: num_dofs values.
[[nodiscard]] Eigen::VectorXd MeasuredSupports(const Scene& scene,
                                               Eigen::Index k);

}  // namespace elastimate

#endif  // ELASTIMATE_CORE_SCENE_UNKNOWN_MOTION_H_
