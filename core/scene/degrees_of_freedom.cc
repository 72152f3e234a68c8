#include "elastimate/core/scene/degrees_of_freedom.h"

#include <algorithm>

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

HeldGroups GroupByHeld(const Scene& scene) {
  HeldGroups groups;
  std::vector<Eigen::Index>& first_cases = groups.first_cases;
  for (Eigen::Index k = 0; k < Eigen::Index(scene.load_cases.size()); ++k) {
    const Supports& supports = SupportsOf(scene, k);
    const auto group = std::find_if(
        first_cases.begin(), first_cases.end(), [&](Eigen::Index first) {
          const Supports& other = SupportsOf(scene, first);
          return &other == &supports || (other.held == supports.held).all();
        });
    groups.of_case.push_back(std::size_t(group - first_cases.begin()));
    if (group == first_cases.end()) {
      first_cases.push_back(k);
    }
  }
  return groups;
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
