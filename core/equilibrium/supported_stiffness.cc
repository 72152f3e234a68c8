#include "elastimate/core/equilibrium/supported_stiffness.h"

namespace elastimate {

SupportedStiffness::SupportedStiffness(const Supports& supports)
    : held_rows_(HeldRowsOn(supports)) {}

std::vector<Eigen::Index> SupportedStiffness::HeldRowsOn(
    const Supports& supports) {
  std::vector<Eigen::Index> rows;
  const auto is_held = supports.held.reshaped();
  for (Eigen::Index row = 0; row < is_held.size(); ++row) {
    if (is_held(row)) {
      rows.push_back(row);
    }
  }
  return rows;
}

Eigen::MatrixXd SupportedStiffness::Extend(const Eigen::MatrixXd& held) {
  return held - Solve(HeldForcesTransposed(held));
}

Eigen::MatrixXd SupportedStiffness::ExtendTransposed(
    const Eigen::MatrixXd& values) {
  return OfHeld(values) - HeldForces(Solve(values));
}

Eigen::MatrixXd SupportedStiffness::OfHeld(
    const Eigen::MatrixXd& values) const {
  Eigen::MatrixXd of_held = Eigen::MatrixXd::Zero(values.rows(), values.cols());
  of_held(held_rows_, Eigen::all) = values(held_rows_, Eigen::all);
  return of_held;
}

}  // namespace elastimate
