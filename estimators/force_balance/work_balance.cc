#include "elastimate/estimators/force_balance/work_balance.h"

#include <cmath>
#include <utility>

#include "elastimate/core/algebra/dense_algebra.h"
#include "elastimate/core/algebra/node_sums.h"
#include "elastimate/core/scene/loads.h"
#include "elastimate/estimators/force_balance/force_residual.h"

namespace elastimate {

WorkBalance::WorkBalance(const Scene& scene, const VirtualWork& work)
    : dofs_(scene.supports),
      forces_(scene.mesh, scene.materials),
      work_(work),
      fields_(work.Fields()) {
  auto [q, f] = WeightLoadCases(scene);
  q_ = std::move(q);
  f_ = dofs_.Restrict(f);
  for (Eigen::Index k = 0; k < q_.cols(); ++k) {
    columns_.push_back(forces_.Columns(q_.col(k)));
    work_of_columns_.push_back(work.Of(columns_.back()));
    ++work_done_.element_passes;
  }
  work_of_loads_ = work.Of(f);
}

bool WorkBalance::Evaluate(const Eigen::VectorXd& moduli,
                           const Eigen::MatrixXd& directions,
                           Eigen::VectorXd* residual,
                           Eigen::MatrixXd* jacobian) {
  // A value and its derivatives are asked for one after the other.
  if (moduli_of_noise_.size() == 0 || moduli != moduli_of_noise_) {
    ++work_done_.element_passes;
    moduli_of_noise_ = moduli;
    noise_ =
        TriangularFactor(dofs_.Restrict(forces_.Multiply(moduli, fields_)));
  }
  if (!(noise_.diagonal().cwiseAbs().minCoeff() > 0) || !noise_.allFinite()) {
    return false;
  }
  const Eigen::Index k = noise_.cols();
  residual->resize(NumEquations());
  if (jacobian != nullptr) {
    jacobian->resize(NumEquations(), directions.cols());
  }
  const auto lower = noise_.transpose().triangularView<Eigen::Lower>();
  for (std::size_t i = 0; i < columns_.size(); ++i) {
    const Eigen::VectorXd z = lower.solve(Eigen::VectorXd(
        work_of_columns_[i] * moduli - work_of_loads_.col(Eigen::Index(i))));
    residual->segment(k * Eigen::Index(i), k) = z;
    if (jacobian != nullptr) {
      const Eigen::VectorXd multipliers =
          noise_.triangularView<Eigen::Upper>().solve(z);
      const Eigen::VectorXd correction = dofs_.Extend(
          dofs_.Restrict(forces_.Multiply(moduli, fields_ * multipliers)));
      work_done_.element_passes += 2;
      jacobian->middleRows(k * Eigen::Index(i), k) =
          lower.solve(Eigen::MatrixXd(
              (work_of_columns_[i] - work_.Of(forces_.Columns(correction))) *
              directions));
    }
  }
  return true;
}

double WorkBalance::BestScale(const Eigen::VectorXd& moduli) const {
  double product = 0;
  double square = 0;
  for (std::size_t i = 0; i < columns_.size(); ++i) {
    const Eigen::VectorXd internal = work_of_columns_[i] * moduli;
    product += internal.dot(work_of_loads_.col(Eigen::Index(i)));
    square += internal.squaredNorm();
  }
  return product / square;
}

Eigen::VectorXd WorkBalance::LeastSquares() const {
  const Eigen::Index k = work_of_loads_.rows();
  Eigen::MatrixXd columns(NumEquations(), work_of_columns_[0].cols());
  for (std::size_t i = 0; i < work_of_columns_.size(); ++i) {
    columns.middleRows(k * Eigen::Index(i), k) = work_of_columns_[i];
  }
  const Eigen::VectorXd scales = columns.colwise().norm();
  return SolveLeastSquares(columns * scales.cwiseInverse().asDiagonal(),
                           work_of_loads_.reshaped())
      .col(0)
      .cwiseQuotient(scales);
}

double WorkBalance::ForceResidualNorm(const Eigen::VectorXd& moduli) const {
  double square_sum = 0;
  for (std::size_t i = 0; i < columns_.size(); ++i) {
    square_sum += SquaredNorm(dofs_.Restrict(columns_[i] * moduli) -
                              f_.col(Eigen::Index(i)));
  }
  return std::sqrt(square_sum);
}

double WorkBalance::LoadNorm() const { return Norm(f_); }

double WorkBalance::DisplacementNorm() const {
  return Norm(dofs_.Restrict(q_));
}

}  // namespace elastimate
