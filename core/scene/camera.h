#ifndef ELASTIMATE_CORE_SCENE_CAMERA_H_
#define ELASTIMATE_CORE_SCENE_CAMERA_H_

#include <Eigen/Core>
#include <vector>

#include "elastimate/core/scene/scene.h"

namespace elastimate {

/// How a camera that moved sees a specimen: a point at x is seen at
///
///   rotation x + translation.
struct Camera {
  Eigen::MatrixXd rotation;     ///< dimension x dimension.
  Eigen::VectorXd translation;  ///< [length]

  static Camera AtRest(int dimension) {
    return {Eigen::MatrixXd::Identity(dimension, dimension),
            Eigen::VectorXd::Zero(dimension)};
  }

  /// Returns where points (dimension x n) are seen.
  Eigen::MatrixXd Seen(const Eigen::MatrixXd& points) const {
    return (rotation * points).colwise() + translation;
  }
  /// Returns the displacement that is seen (num_dofs) of a mesh whose nodes are
  /// displaced by `displacement` (num_dofs): rotation (x + u) + translation -
  /// x.
  Eigen::VectorXd SeenDisplacement(const Mesh& mesh,
                                   const Eigen::VectorXd& displacement) const;
  /// Returns the rotation in [0, pi].
  double Angle() const;
};

/// Returns what the camera of each load case sees of displacements, num_dofs x
/// num_load_cases; these as they are where there are no cameras.
[[nodiscard]] Eigen::MatrixXd SeenDisplacements(
    const Mesh& mesh, Eigen::MatrixXd displacements,
    const std::vector<Camera>& cameras);

/// Returns the rotation about the mean a of the observed positions x that
/// brings them nearest to where they were observed in a load case, up to a
/// translation b:
///
///   the least sum over the observed components of (x + u - a - b - R (x -
///   a))^2,
///
/// whichever components of each point were observed, and however far the camera
/// turned.  The search begins at the affine map of least squares of each
/// component, where the search for a turn by 120 degrees ends as well.  If all
/// points lie in a plane, and the component across it was not observed, a tilt
/// of the plane looks like a strain, and the turn that is returned has no tilt.
/// The camera is at rest if nothing was measured.
///
/// Precondition: a valid scene.  O(num_nodes + num_points).
[[nodiscard]] Camera TurnOfCamera(const Scene& scene,
                                  const LoadCase& load_case);

}  // namespace elastimate

#endif  // ELASTIMATE_CORE_SCENE_CAMERA_H_
