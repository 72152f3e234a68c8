#include "elastimate/estimators/force_balance/monomials.h"

#include "elastimate/core/algebra/dense_algebra.h"

namespace elastimate {
namespace {

// An extent of this share of the longest is rounding.
constexpr double kFlat = 1e-10;

// Coordinates of zero mean and unit covariance.
Eigen::MatrixXd Standardize(Eigen::MatrixXd x) {
  x.colwise() -= x.rowwise().mean().eval();
  const SymmetricEigenDecomposition axes =
      DecomposeSymmetric(x * x.transpose() / static_cast<double>(x.cols()));
  const Eigen::VectorXd extent = axes.values.cwiseMax(0).cwiseSqrt();
  Eigen::MatrixXd coordinates = axes.vectors.transpose() * x;
  for (Eigen::Index i = 0; i < x.rows(); ++i) {
    const bool is_flat = !(extent(i) > kFlat * extent(x.rows() - 1));
    coordinates.row(i) *= is_flat ? 0 : 1 / extent(i);
  }
  return coordinates;
}

}  // namespace

Eigen::MatrixXd Monomials(const Eigen::MatrixXd& points, int degree) {
  const Eigen::MatrixXd x = Standardize(points);
  const bool is_planar = x.rows() == 2;
  Eigen::MatrixXd monomials(x.cols(), NumMonomials(x.rows(), degree));
  monomials.col(0).setOnes();
  Eigen::Index column = 0;
  for (int i = 0; i <= degree; ++i) {
    for (int j = 0; i + j <= degree; ++j) {
      const Eigen::ArrayXd product =
          x.row(0).array().pow(i) * x.row(1).array().pow(j);
      for (int k = 0; k <= (is_planar ? 0 : degree - i - j); ++k) {
        monomials.col(column) = product;
        if (k > 0) {
          monomials.col(column).array() *= x.row(2).transpose().array().pow(k);
        }
        ++column;
      }
    }
  }
  return monomials;
}

}  // namespace elastimate
