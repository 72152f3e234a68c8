#include "elastimate/estimators/material_fit/motion_elimination.h"

#include <algorithm>
#include <cmath>

namespace elastimate {
namespace {

// The gradient of the least squares that is left, relative to that at the
// start: of a fit, so small that measurements without noise are met to
// rounding; of sensitivities, so small that it does not slow a Gauss-Newton
// step down.
constexpr double kExact = 1e-12;
constexpr double kOfSensitivities = 1e-7;
constexpr int kLargestNumberOfIterations = 2000;

}  // namespace

MotionElimination::MotionElimination(const Scene& scene,
                                     const ObservedDisplacements& observed,
                                     Equilibrium& model)
    : observed_(observed), model_(model), motion_(scene) {
  const int dimension = scene.mesh.Dimension();
  const Eigen::MatrixXd measured = MeasuredSupports(scene);
  const Eigen::Index num_cases = Eigen::Index(scene.load_cases.size());
  amounts_.setZero(motion_.NumAmounts() * num_cases);
  for (Eigen::Index k = 0; k < num_cases; ++k) {
    amounts_.segment(motion_.NumAmounts() * k, motion_.of_supports.cols()) =
        motion_.of_supports.transpose() * measured.col(k);
    for (const Resultant& resultant : scene.load_cases[k].resultants) {
      for (int i = 0; i < dimension; ++i) {
        if (std::isnan(resultant.force(i))) {
          continue;
        }
        ResultantRow row = {k, {}, resultant.force(i), resultant.noise_sd(i)};
        for (const int node : resultant.nodes) {
          if (scene.supports.held(i, node)) {
            row.held.push_back(dimension * Eigen::Index(node) + i);
          }
        }
        resultants_.push_back(row);
      }
    }
  }
}

Eigen::VectorXd MotionElimination::Fit() {
  model_.Superpose(SupportMotion(amounts_));
  Eigen::VectorXd rows = RowsOf(
      WithMotionOfAll(amounts_, model_.Displacement()), model_.SupportForces());
  rows.head(observed_.Size()) -= observed_.Measured();
  rows.tail(NumResultants()) -= noise_ * MeasuredResultants();
  const Eigen::VectorXd surplus = Minimize(kExact, rows);
  amounts_ -= surplus;
  model_.Superpose(-SupportMotion(surplus));
  return rows;
}

Eigen::VectorXd MotionElimination::Eliminate(
    const Eigen::MatrixXd& displacements,
    const Eigen::MatrixXd& support_forces) {
  Eigen::VectorXd rows = RowsOf(displacements, support_forces);
  Minimize(kOfSensitivities, rows);
  return rows;
}

Eigen::VectorXd MotionElimination::Resultants(
    const Eigen::MatrixXd& support_forces) const {
  Eigen::VectorXd forces(NumResultants());
  for (Eigen::Index i = 0; i < forces.size(); ++i) {
    const ResultantRow& row = resultants_[i];
    forces(i) = support_forces.col(row.load_case)(row.held).sum() / row.noise_sd;
  }
  return forces;
}

Eigen::VectorXd MotionElimination::MeasuredResultants() const {
  Eigen::VectorXd forces(NumResultants());
  std::transform(
      resultants_.begin(), resultants_.end(), forces.begin(),
      [](const ResultantRow& row) { return row.force / row.noise_sd; });
  return forces;
}

Eigen::VectorXd MotionElimination::RowsOf(
    const Eigen::MatrixXd& displacements,
    const Eigen::MatrixXd& support_forces) const {
  Eigen::VectorXd rows(NumRows());
  rows << observed_.Restrict(displacements),
      noise_ * Resultants(support_forces);
  return rows;
}

Eigen::MatrixXd MotionElimination::SupportMotion(
    const Eigen::VectorXd& amounts) {
  const auto of_cases =
      amounts.reshaped(motion_.NumAmounts(), observed_.NumLoadCases());
  return model_.Extend(motion_.of_supports *
                       of_cases.topRows(motion_.of_supports.cols()));
}

Eigen::MatrixXd MotionElimination::WithMotionOfAll(
    const Eigen::VectorXd& amounts, Eigen::MatrixXd displacements) const {
  const auto of_cases =
      amounts.reshaped(motion_.NumAmounts(), observed_.NumLoadCases());
  displacements += motion_.of_all * of_cases.bottomRows(motion_.of_all.cols());
  return displacements;
}

Eigen::VectorXd MotionElimination::Multiply(const Eigen::VectorXd& amounts) {
  const Eigen::MatrixXd motion = SupportMotion(amounts);
  return RowsOf(WithMotionOfAll(amounts, motion), model_.HeldForces(motion));
}

Eigen::VectorXd MotionElimination::MultiplyTransposed(
    const Eigen::VectorXd& rows) {
  const Eigen::MatrixXd of_nodes =
      observed_.RestrictTransposed(rows.head(observed_.Size()));
  Eigen::MatrixXd forces =
      Eigen::MatrixXd::Zero(of_nodes.rows(), of_nodes.cols());
  for (Eigen::Index i = 0; i < NumResultants(); ++i) {
    const ResultantRow& row = resultants_[i];
    for (const Eigen::Index dof : row.held) {
      forces(dof, row.load_case) +=
          noise_ / row.noise_sd * rows(observed_.Size() + i);
    }
  }
  Eigen::MatrixXd amounts(motion_.NumAmounts(), observed_.NumLoadCases());
  amounts << motion_.of_supports.transpose() *
                 model_.ExtendTransposed(of_nodes +
                                         model_.HeldForcesTransposed(forces)),
      motion_.of_all.transpose() * of_nodes;
  return amounts.reshaped();
}

Eigen::VectorXd MotionElimination::Minimize(double tolerance,
                                            Eigen::VectorXd& rows) {
  Eigen::VectorXd amounts = Eigen::VectorXd::Zero(amounts_.size());
  Eigen::VectorXd gradient = MultiplyTransposed(rows);
  Eigen::VectorXd direction = gradient;
  double square = gradient.squaredNorm();
  const double enough = tolerance * tolerance * square;
  for (int i = 0; i < kLargestNumberOfIterations && square > enough; ++i) {
    const Eigen::VectorXd step = Multiply(direction);
    const double length = square / step.squaredNorm();
    amounts += length * direction;
    rows -= length * step;
    gradient = MultiplyTransposed(rows);
    const double next = gradient.squaredNorm();
    direction = gradient + next / square * direction;
    square = next;
  }
  return amounts;
}

}  // namespace elastimate
