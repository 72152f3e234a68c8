#ifndef ELASTIMATE_CORE_SCENE_RIGID_MOTION_H_
#define ELASTIMATE_CORE_SCENE_RIGID_MOTION_H_

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <string>

#include "elastimate/core/mesh/mesh.h"
#include "elastimate/core/scene/scene.h"

namespace elastimate {

/// Counts the rigid motions of a body: three in the plane, six in space.
constexpr int NumRigidMotions(int dimension) { return dimension == 3 ? 6 : 3; }

/// Returns how rigid motions move a point: the translations along the axes,
/// then the rotations about axes at which `arm` starts.  dimension x
/// NumRigidMotions.
inline Eigen::MatrixXd RigidMotionsAt(const Eigen::VectorXd& arm) {
  const Eigen::Index dimension = arm.size();
  Eigen::MatrixXd motions(dimension, NumRigidMotions(int(dimension)));
  motions.leftCols(dimension).setIdentity();
  if (dimension == 2) {
    motions.col(2) << -arm(1), arm(0);
    return motions;
  }
  const Eigen::Vector3d of_arm = arm;
  for (int axis = 0; axis < 3; ++axis) {
    motions.col(3 + axis) =
        Eigen::Vector3d(Eigen::Vector3d::Unit(axis)).cross(of_arm);
  }
  return motions;
}

/// Returns RigidMotionsAt of some points (dimension x n), each below the other:
/// (dimension n) x NumRigidMotions.
inline Eigen::MatrixXd RigidMotionsOf(const Eigen::MatrixXd& arms) {
  const Eigen::Index dimension = arms.rows();
  Eigen::MatrixXd motions(arms.size(), NumRigidMotions(int(dimension)));
  for (Eigen::Index i = 0; i < arms.cols(); ++i) {
    motions.middleRows(dimension * i, dimension) = RigidMotionsAt(arms.col(i));
  }
  return motions;
}

/// Returns where a rigid motion of any size takes points (dimension x n): R x +
/// t.  `motion` has the translation t first, then the angle [rad] about the
/// origin, or in space the rotation vector, which is the axis times the angle.
/// To first order, RigidMotionsAt(x) * motion is what it adds to x.
[[nodiscard]] Eigen::MatrixXd MovedRigidly(const Eigen::MatrixXd& points,
                                           const Eigen::VectorXd& motion);

/// Returns the motion, as MovedRigidly takes it, that moves points (dimension x
/// n) by `change` (as large) to first order, or by what is nearest to it in the
/// sense of least squares.  Points on one line do not turn about it.  O(n).
[[nodiscard]] Eigen::VectorXd RigidMotionNearest(const Eigen::MatrixXd& points,
                                                 const Eigen::MatrixXd& change);

/// Tells why the supports do not hold the specimen: the sentence names a motion
/// without strain which they allow (a translation or a rotation of a part of
/// the mesh).  It is empty when there is none; only then a finite element
/// solution exists.
///
/// Elements that are connected through their faces move as a rigid body where
/// they have no strain; bodies that share only an edge or a node are hinged
/// there.
///
/// Precondition: a valid mesh.  O(num_elements log(num_elements)), and a sparse
/// factorisation with as many unknowns as rigid motions for each hinged body.
[[nodiscard]] std::string WhyNotHeld(const Mesh& mesh,
                                     const Supports& supports);

/// Checks the supports of each load case of a scene, and names the load case
/// where the supports are its own.
[[nodiscard]] std::string WhyNotHeld(const Scene& scene);

}  // namespace elastimate

#endif  // ELASTIMATE_CORE_SCENE_RIGID_MOTION_H_
