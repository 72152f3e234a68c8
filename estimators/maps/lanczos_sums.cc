#include "elastimate/estimators/maps/lanczos_sums.h"

#include <limits>

#include "elastimate/core/algebra/dense_algebra.h"

namespace elastimate {
namespace {

// Returns columns of unit length, and zero for those that are rounding beside
// `scales`.
Eigen::MatrixXd Normalised(const Eigen::MatrixXd& columns,
                           Eigen::RowVectorXd& norms,
                           const Eigen::RowVectorXd& scales) {
  constexpr double kRounding = 100 * std::numeric_limits<double>::epsilon();
  norms = columns.colwise().norm();
  norms = (norms.array() > kRounding * scales.array()).select(norms, 0);
  const Eigen::RowVectorXd factors =
      (norms.array() > 0).select(norms.cwiseInverse(), 0);
  return columns * factors.asDiagonal();
}

}  // namespace

LanczosSums::LanczosSums(const ColumnOperator& multiply,
                         const Eigen::MatrixXd& vectors, int steps)
    : nodes_(steps, vectors.cols()), weights_(steps, vectors.cols()) {
  const Eigen::Index n = vectors.cols();
  Eigen::MatrixXd alphas = Eigen::MatrixXd::Zero(steps, n);
  Eigen::MatrixXd betas = Eigen::MatrixXd::Zero(steps, n);
  Eigen::RowVectorXd lengths;
  Eigen::MatrixXd last = Eigen::MatrixXd::Zero(vectors.rows(), n);
  Eigen::MatrixXd present =
      Normalised(vectors, lengths, Eigen::RowVectorXd::Zero(n));
  Eigen::RowVectorXd beta = Eigen::RowVectorXd::Zero(n);
  for (int j = 0; j < steps && !present.isZero(0); ++j) {
    Eigen::MatrixXd next = multiply(present);
    const Eigen::RowVectorXd scales = next.colwise().norm();
    alphas.row(j) = present.cwiseProduct(next).colwise().sum();
    next -= present * alphas.row(j).asDiagonal() + last * beta.asDiagonal();
    last = std::move(present);
    present = Normalised(next, beta, scales);
    betas.row(j) = beta;
  }
  for (Eigen::Index column = 0; column < n; ++column) {
    Eigen::MatrixXd tridiagonal = alphas.col(column).asDiagonal();
    tridiagonal.diagonal(-1) = betas.col(column).head(steps - 1);
    const SymmetricEigenDecomposition of_column =
        DecomposeSymmetric(tridiagonal);
    nodes_.col(column) = of_column.values.cwiseMax(0.0);
    weights_.col(column) = lengths(column) * lengths(column) *
                           of_column.vectors.row(0).transpose().cwiseAbs2();
  }
}

}  // namespace elastimate
