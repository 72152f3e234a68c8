#include "elastimate/core/equilibrium/supported_stiffness.h"

namespace elastimate {

SupportedStiffness::SupportedStiffness(const Supports& supports)
    : is_free_(IsFreeOn(supports)) {}

Eigen::VectorXd SupportedStiffness::IsFreeOn(const Supports& supports) {
  return (!supports.held).cast<double>().matrix().reshaped();
}

Eigen::MatrixXd SupportedStiffness::Extend(const Eigen::MatrixXd& held) {
  return held - Solve(HeldForcesTransposed(held));
}

Eigen::MatrixXd SupportedStiffness::ExtendTransposed(
    const Eigen::MatrixXd& values) {
  return OfHeld(values) - HeldForces(Solve(values));
}

Eigen::MatrixXd SupportedStiffness::OfHeld(Eigen::MatrixXd values) const {
  for (Eigen::Index k = 0; k < values.cols(); ++k) {
    values.col(k) = (is_free_.array() != 0).select(0.0, values.col(k));
  }
  return values;
}

}  // namespace elastimate
