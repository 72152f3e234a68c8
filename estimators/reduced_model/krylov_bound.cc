#include "elastimate/estimators/reduced_model/krylov_bound.h"

#include <algorithm>
#include <cmath>

#include "elastimate/core/algebra/dense_algebra.h"
#include "elastimate/core/laws/elasticity.h"

namespace elastimate {

double SmallestEnergyRatio(double poisson_ratio, double pole,
                           SectionModel model) {
  const double least = -ShearShareOfJ(model);
  const double largest = model == SectionModel::kPlaneStrain ? 0 : 1;
  return std::min((1 + least * poisson_ratio) / (1 + least * pole),
                  (1 + largest * poisson_ratio) / (1 + largest * pole));
}

KrylovBound::KrylovBound(SectionModel model, double pole, double start_norm,
                         double start_error, double direction_error)
    : section_model_(model),
      pole_(pole),
      start_norm_(start_norm),
      start_error_(start_error),
      direction_error_(direction_error),
      remainder_norm_(start_norm) {}

void KrylovBound::Extend(const Eigen::VectorXd& column, double solve_error,
                         double remainder_norm) {
  const Eigen::Index m = column.size();
  t_.conservativeResize(m, m);
  t_.col(m - 1) = column;
  t_.row(m - 1) = column.transpose();
  solve_errors_.conservativeResize(m);
  solve_errors_(m - 1) = solve_error;
  remainder_norm_ = remainder_norm;
  SymmetricEigenDecomposition eigen = DecomposeSymmetric(t_);
  theta_ = std::move(eigen.values);
  modes_ = std::move(eigen.vectors);
}

double KrylovBound::At(double poisson_ratio) const {
  // The node lies below the spectrum by more than rounding moves either.
  constexpr double kBelow = 1 - 1e-6;
  const double distance = std::abs(poisson_ratio - pole_);
  const double node =
      kBelow * SmallestEnergyRatio(poisson_ratio, pole_, section_model_);
  const Eigen::Index m = t_.cols();
  if (m == 0) {
    return (distance * (start_norm_ + direction_error_) + start_error_) /
           std::sqrt(node);
  }
  const Eigen::ArrayXd lambda =
      (1 + (poisson_ratio - pole_) * theta_.array()).max(node);
  const Eigen::ArrayXd first = modes_.row(0).transpose();
  const Eigen::ArrayXd last = modes_.row(m - 1).transpose();
  const double coupling = distance * remainder_norm_;
  const Eigen::ArrayXd above = (lambda - node).max((1 - kBelow) * node);
  const double radau =
      node + coupling * coupling *
                 (last.square() * (1 / above - 1 / lambda).max(0)).sum();
  const Eigen::VectorXd y = start_norm_ * (modes_ * (first / lambda).matrix());
  const double of_space = coupling * std::abs(y(m - 1)) / std::sqrt(radau);
  // What a solve is off leaves a residual of its own, and changes T.
  const double of_solves =
      2 * direction_error_ + 2 * distance * y.cwiseAbs().dot(solve_errors_);
  return distance * of_space +
         (distance * of_solves + start_error_) / std::sqrt(node);
}

}  // namespace elastimate
