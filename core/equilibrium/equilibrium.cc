#include "elastimate/core/equilibrium/equilibrium.h"

#include <vector>

#include "elastimate/core/scene/loads.h"
#include "elastimate/core/scene/unknown_motion.h"

namespace elastimate {

Equilibrium::Equilibrium(const Scene& scene, SolverKind solver)
    : forces_(scene.mesh, scene.materials),
      solver_(scene.mesh, scene.supports, solver),
      load_(AssembleLoadCases(scene)),
      held_displacement_(HeldDisplacement(scene.supports)),
      has_unknown_motion_(HasUnknownMotion(scene)) {
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
  const Eigen::MatrixXd blocks = forces_.Blocks(scaled, solver_.Graph());
  if (!solver_.FactorizeBlocks(blocks)) {
    return false;
  }
  if (has_unknown_motion_) {
    AssembleHeldRows(blocks);
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

void Equilibrium::AssembleHeldRows(const Eigen::MatrixXd& blocks) {
  const NodeGraph& graph = solver_.Graph();
  const Eigen::Index d = blocks.rows();
  std::vector<Eigen::Triplet<double>> entries;
  const auto add = [&](Eigen::Index row, Eigen::Index column, double value) {
    if (IsHeld(row)) {
      entries.emplace_back(row, column, value);
    }
  };
  for (Eigen::Index j = 0; j + 1 < Eigen::Index(graph.start.size()); ++j) {
    for (Eigen::Index pair = graph.start[j]; pair < graph.start[j + 1];
         ++pair) {
      const Eigen::Index i = graph.row[pair];
      for (Eigen::Index a = 0; a < d; ++a) {
        for (Eigen::Index b = 0; b < d; ++b) {
          const double value = blocks(a, d * pair + b);
          add(d * i + a, d * j + b, value);
          if (i != j) {
            add(d * j + b, d * i + a, value);
          }
        }
      }
    }
  }
  held_rows_.resize(load_.rows(), load_.rows());
  held_rows_.setFromTriplets(entries.begin(), entries.end());
}

Eigen::MatrixXd Equilibrium::OfHeld(Eigen::MatrixXd values) const {
  for (const Eigen::Index dof : solver_.Dofs().free) {
    values.row(dof).setZero();
  }
  return values;
}

Eigen::MatrixXd Equilibrium::Extend(const Eigen::MatrixXd& held) {
  return held - solver_.Solve(held_rows_.transpose() * held);
}

Eigen::MatrixXd Equilibrium::ExtendTransposed(const Eigen::MatrixXd& values) {
  return OfHeld(values) - held_rows_ * solver_.Solve(values);
}

void Equilibrium::Superpose(const Eigen::MatrixXd& displacement) {
  displacement_ += displacement;
}

Eigen::MatrixXd Equilibrium::HeldForces(
    const Eigen::MatrixXd& displacements) const {
  return scale_ * (held_rows_ * displacements);
}

Eigen::MatrixXd Equilibrium::HeldForcesTransposed(
    const Eigen::MatrixXd& held) const {
  return scale_ * (held_rows_.transpose() * held);
}

Eigen::MatrixXd Equilibrium::SupportForces() const {
  return HeldForces(displacement_) - OfHeld(load_);
}

Eigen::MatrixXd Equilibrium::SupportForceSensitivities(
    const Eigen::MatrixXd& directions, const Eigen::MatrixXd& sensitivities) {
  const Eigen::Index n = directions.cols();
  Eigen::MatrixXd forces = HeldForces(sensitivities);
  for (Eigen::Index k = 0; k < displacement_.cols(); ++k) {
    ++element_passes_;
    forces.middleCols(n * k, n) +=
        OfHeld(forces_.Columns(displacement_.col(k)) * directions);
  }
  return forces;
}

Work Equilibrium::WorkDone() const {
  Work work = solver_.WorkDone();
  work.element_passes += element_passes_;
  return work;
}

}  // namespace elastimate
