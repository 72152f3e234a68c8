#include "elastimate/core/scene/degrees_of_freedom.h"

namespace elastimate {

DegreesOfFreedom::DegreesOfFreedom(const Supports& supports)
    : dimension(static_cast<int>(supports.held.rows())),
      place(supports.held.size(), -1) {
  free.reserve(supports.held.size() - supports.held.count());
  for (Eigen::Index dof = 0; dof < supports.held.size(); ++dof) {
    if (!supports.held.data()[dof]) {
      place[dof] = NumFree();
      free.push_back(dof);
    }
  }
}

Eigen::MatrixXd DegreesOfFreedom::Restrict(const Eigen::MatrixXd& all) const {
  return all(free, Eigen::all);
}

Eigen::MatrixXd DegreesOfFreedom::Extend(const Eigen::MatrixXd& values) const {
  Eigen::MatrixXd all = Eigen::MatrixXd::Zero(NumAll(), values.cols());
  all(free, Eigen::all) = values;
  return all;
}

Eigen::VectorXd HeldDisplacement(const Supports& supports) {
  return supports.held.select(supports.displacement.array(), 0.0)
      .reshaped()
      .matrix();
}

Eigen::MatrixXd OfHeld(const Scene& scene, const Eigen::MatrixXd& values) {
  Eigen::MatrixXd held = values;
  for (Eigen::Index k = 0; k < values.cols(); ++k) {
    held.col(k) =
        SupportsOf(scene, k).held.reshaped().select(values.col(k).array(), 0.0);
  }
  return held;
}

}  // namespace elastimate
