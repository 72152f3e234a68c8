#include "elastimate/core/stiffness_solver.h"

#include <limits>
#include <stdexcept>

namespace elastimate {

StiffnessSolver::StiffnessSolver(const Mesh& mesh, const Supports& supports)
    : degrees_of_freedom_(supports),
      poisson_ratio_(std::numeric_limits<double>::quiet_NaN()) {
  const std::string why_not_held = WhyNotHeld(mesh, supports);
  if (!why_not_held.empty()) {
    throw std::invalid_argument(why_not_held);
  }
  assembly_ = std::make_unique<StiffnessAssembly>(mesh, degrees_of_freedom_);
  ++work_.element_passes;
  cholesky_ = std::make_unique<Cholesky>(*assembly_, degrees_of_freedom_);
}

bool StiffnessSolver::Factorize(double poisson_ratio) {
  if (poisson_ratio == poisson_ratio_) {
    return true;
  }
  poisson_ratio_ = std::numeric_limits<double>::quiet_NaN();
  if (!(poisson_ratio > -1 && poisson_ratio < 0.5)) {
    return false;
  }
  ++work_.factorizations;
  assembly_->Combine(poisson_ratio, values_);
  if (!cholesky_->Factorize(values_)) {
    return false;
  }
  poisson_ratio_ = poisson_ratio;
  return true;
}

Eigen::MatrixXd StiffnessSolver::Solve(const Eigen::MatrixXd& all) {
  work_.solves += static_cast<int>(all.cols());
  return degrees_of_freedom_.Extend(
      cholesky_->Solve(degrees_of_freedom_.Restrict(all)));
}

}  // namespace elastimate
