#include "elastimate/organ/organ_shape.h"

#include <Eigen/Geometry>
#include <cmath>

namespace elastimate {
namespace {

// The map from the ball (a, b, c) to the organ changes one coordinate after the
// other, each by the ones already known, so that it can be inverted exactly.
double Height(double a) { return 0.28 * std::exp(-0.65 * a); }
double HeightOffset(double x) { return 0.24 * x - 0.4 * x * x; }
double Depth(double a, double c) {
  return 0.17 * std::exp(-0.45 * a + 0.4 * c);
}
double DepthOffset(double x, double z) {
  return 0.5 * x * x + 0.8 * (z - 0.08) * (z - 0.08);
}
Eigen::Matrix3d Tilt() {
  return Eigen::AngleAxisd(20.0 * kDegree, Eigen::Vector3d::UnitX())
      .toRotationMatrix();
}

}  // namespace

Eigen::Vector3d OrganPoint(const Eigen::Vector3d& ball_point) {
  const double a = ball_point.x();
  const double b = ball_point.y();
  const double c = ball_point.z();
  const double x = 0.5 * a;
  const double z = Height(a) * c + HeightOffset(x);
  const double y = Depth(a, c) * b + DepthOffset(x, z);
  return Tilt() * Eigen::Vector3d(x, y, z);
}

Eigen::Vector3d BallPoint(const Eigen::Vector3d& organ_point) {
  const Eigen::Vector3d point = Tilt().transpose() * organ_point;
  const double x = point.x();
  const double y = point.y();
  const double z = point.z();
  const double a = 2.0 * x;
  const double c = (z - HeightOffset(x)) / Height(a);
  const double b = (y - DepthOffset(x, z)) / Depth(a, c);
  return {a, b, c};
}

}  // namespace elastimate
