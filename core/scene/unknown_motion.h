#ifndef ELASTIMATE_CORE_SCENE_UNKNOWN_MOTION_H_
#define ELASTIMATE_CORE_SCENE_UNKNOWN_MOTION_H_

#include <Eigen/Core>
#include <Eigen/SparseCore>

#include "elastimate/core/scene/scene.h"

namespace elastimate {

/// Tells whether displacements of supports, or of the whole specimen, are not
/// known, or forces of supports were measured.  O(1).
[[nodiscard]] bool HasUnknownMotion(const Scene& scene);

/// Validates unknown displacements of supports and resultants, as a part of
/// ValidateScene.  O(num_dofs num_load_cases).
void ValidateUnknownMotion(const Scene& scene);

/// Returns the held components that moved as measured: those of unknown
/// displacement that are not in rigid faces.  dimension x num_nodes; empty when
/// there are no unknown displacements.
[[nodiscard]] ComponentMask AsMeasured(const Supports& supports);

/// The motions by unknown amounts b and a in a load case,
///
///   u of the supports = given + G b,   what was measured = u + R a + noise.
///
/// These are linear, and hold for small rotations.  Where rotations are large,
/// they are increments about a state (Positions,
/// FiniteIncrement).
///
/// Amounts are lengths.  Nodes that a refinement put into supports that moved
/// as measured (Supports::middles), and mid-edge nodes of a mesh of order 2
/// there, move as the mean of the two nodes at their ends where they were
/// measured in no load case of these supports.
struct UnknownMotion {
  /// G: num_dofs x n.  It has one column for each displacement that is as
  /// measured, and the rigid motions of each face, three to six at most.
  Eigen::SparseMatrix<double> of_supports;
  /// R: num_dofs x 3 or 6 where a rigid motion of the specimen is free, else x
  /// 0.
  Eigen::MatrixXd of_all;

  /// Where rigid bodies are whose increments are asked for, dimension x
  /// num_nodes each.
  struct Positions {
    Eigen::MatrixXd of_faces;  ///< The nodes, where the supports moved them.
    Eigen::MatrixXd of_all;    ///< The nodes, where the camera sees them.
  };

  /// Takes the load cases of the scene that have these supports.  Precondition:
  /// a valid scene.  O(num_dofs num_load_cases).
  UnknownMotion(const Scene& scene, const Supports& supports);
  /// Takes the increments of rigid motions about these positions in place of
  /// those of the mesh.  Rigid faces some of whose components are free are
  /// taken where they are in the mesh.
  UnknownMotion(const Scene& scene, const Supports& supports,
                const Positions& positions);

  /// Returns how many amounts there are in a load case.
  Eigen::Index NumAmounts() const { return of_supports.cols() + of_all.cols(); }
};

/// Returns how increments of supports (num_dofs) move them from
/// `displacement` (num_dofs): rigid faces all of whose components are held move
/// by the finite rotation, so that they stay rigid, all others linearly.
[[nodiscard]] Eigen::VectorXd FiniteIncrement(
    const Mesh& mesh, const Supports& supports,
    const Eigen::VectorXd& displacement, const Eigen::VectorXd& increment);

/// Returns the measured displacement of AsMeasured in load case `k`, num_dofs
/// values; zero elsewhere and where a node was not measured.
[[nodiscard]] Eigen::VectorXd MeasuredSupports(const Scene& scene,
                                               Eigen::Index k);

}  // namespace elastimate

#endif  // ELASTIMATE_CORE_SCENE_UNKNOWN_MOTION_H_
