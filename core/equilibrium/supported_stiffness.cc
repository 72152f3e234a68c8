#include "elastimate/core/equilibrium/supported_stiffness.h"

namespace elastimate {

Eigen::MatrixXd SupportedStiffness::Extend(const Eigen::MatrixXd& held) {
  return held - Solve(HeldForcesTransposed(held));
}

Eigen::MatrixXd SupportedStiffness::ExtendTransposed(
    const Eigen::MatrixXd& values) {
  return OfHeld(values) - HeldForces(Solve(values));
}

Eigen::MatrixXd SupportedStiffness::OfHeld(Eigen::MatrixXd values) const {
  for (const Eigen::Index dof : dofs_.free) {
    values.row(dof).setZero();
  }
  return values;
}

}  // namespace elastimate
