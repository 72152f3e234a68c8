#include "elastimate/estimators/force_balance/monomials.h"

#include "elastimate/core/algebra/dense_algebra.h"

namespace elastimate {
namespace {

// An extent of this share of the longest is rounding.
constexpr double kFlat = 1e-10;

// Coordinates of zero mean and unit covariance.
Eigen::Matrix3Xd Standardize(Eigen::Matrix3Xd x) {
  x.colwise() -= x.rowwise().mean().eval();
  const SymmetricEigenDecomposition axes =
      DecomposeSymmetric(x * x.transpose() / static_cast<double>(x.cols()));
  const Eigen::Vector3d extent = axes.values.cwiseMax(0).cwiseSqrt();
  Eigen::Matrix3Xd coordinates = axes.vectors.transpose() * x;
  for (int i = 0; i < 3; ++i) {
    const bool is_flat = !(extent(i) > kFlat * extent(2));
    coordinates.row(i) *= is_flat ? 0 : 1 / extent(i);
  }
  return coordinates;
}

}  // namespace

Eigen::MatrixXd Monomials(const Eigen::Matrix3Xd& points, int degree) {
  const Eigen::Matrix3Xd x = Standardize(points);
  Eigen::MatrixXd monomials(x.cols(),
                            (degree + 1) * (degree + 2) * (degree + 3) / 6);
  monomials.col(0).setOnes();
  Eigen::Index column = 0;
  for (int i = 0; i <= degree; ++i) {
    for (int j = 0; i + j <= degree; ++j) {
      for (int k = 0; i + j + k <= degree; ++k) {
        monomials.col(column++) = x.row(0).array().pow(i) *
                                  x.row(1).array().pow(j) *
                                  x.row(2).array().pow(k);
      }
    }
  }
  return monomials;
}

Eigen::MatrixXd SmoothByPolynomials(const Eigen::Matrix3Xd& points,
                                    const Eigen::MatrixXd& values, int degree) {
  const Eigen::MatrixXd monomials = Monomials(points, degree);
  return monomials * SolveLeastSquares(monomials, values, kDependentMonomial);
}

}  // namespace elastimate
