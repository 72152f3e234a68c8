#ifndef ELASTIMATE_ORGAN_ORGAN_SHAPE_H_
#define ELASTIMATE_ORGAN_ORGAN_SHAPE_H_

#include <Eigen/Core>

namespace elastimate {

inline constexpr double kDegree = 0.017453292519943295;  ///< In radians.

/// The organ is the image of the unit ball under this smooth, invertible map:
/// an ellipsoid whose height and depth taper from the right lobe (x = -1/2) to
/// the left lobe (x = 1/2), whose lower edge is thin, and which is bent around
/// what lies behind (+y) and below (-z) it.  Its extent along x is 1.
Eigen::Vector3d OrganPoint(const Eigen::Vector3d& ball_point);

/// Returns the point that OrganPoint maps to this one.  Its norm is 1 for a
/// point of the organ's surface, and below 1 inside.
Eigen::Vector3d BallPoint(const Eigen::Vector3d& organ_point);

}  // namespace elastimate

#endif  // ELASTIMATE_ORGAN_ORGAN_SHAPE_H_
