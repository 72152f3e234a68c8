#include "elastimate/core/equilibrium/equilibrium.h"

#include "elastimate/core/scene/loads.h"

namespace elastimate {

Equilibrium::Equilibrium(const Scene& scene, SolverKind solver)
    : forces_(scene.mesh, scene.materials),
      solver_(scene.mesh, scene.supports, solver),
      load_(AssembleLoadCases(scene)),
      held_displacement_(HeldDisplacement(scene.supports)) {
  if (!held_displacement_.isZero(0)) {
    held_forces_ = forces_.Columns(held_displacement_);
    ++element_passes_;
  }
}

bool Equilibrium::Solve(const Eigen::VectorXd& moduli) {
  ++element_passes_;
  // Of moduli of any unit, a stiffness without one.
  scale_ = moduli.cwiseAbs().maxCoeff();
  const Eigen::VectorXd scaled = moduli / scale_;
  if (!solver_.FactorizeBlocks(forces_.Blocks(scaled, solver_.Graph()))) {
    return false;
  }
  support_response_ = held_displacement_;
  if (held_forces_.size() > 0) {
    support_response_ -= solver_.Solve(held_forces_ * scaled);
  }
  displacement_ = solver_.Solve(load_) / scale_;
  displacement_.colwise() += support_response_;
  return !displacement_.hasNaN();
}

Eigen::MatrixXd Equilibrium::Sensitivities(const Eigen::MatrixXd& directions) {
  const Eigen::Index n = directions.cols();
  Eigen::MatrixXd sensitivities(displacement_.rows(), n * displacement_.cols());
  for (Eigen::Index k = 0; k < displacement_.cols(); ++k) {
    ++element_passes_;
    sensitivities.middleCols(n * k, n) = -solver_.Solve(
        forces_.Columns(displacement_.col(k)) * (directions / scale_));
  }
  return sensitivities;
}

Work Equilibrium::WorkDone() const {
  Work work = solver_.WorkDone();
  work.element_passes += element_passes_;
  return work;
}

}  // namespace elastimate
