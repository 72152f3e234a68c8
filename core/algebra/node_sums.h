#ifndef ELASTIMATE_CORE_ALGEBRA_NODE_SUMS_H_
#define ELASTIMATE_CORE_ALGEBRA_NODE_SUMS_H_

#include <Eigen/Core>

namespace elastimate {

// Sums over all nodes or all rows of a measurement, beside the QR
// factorisations of dense_algebra.h and row_block_qr.h.  Whatever runs over a
// whole body and ends in a few numbers goes through these functions, so that
// one that is divided among processes has one place to add up what each of them
// holds. Columns are n long; costs are O(n) for each pair of columns.

/// x^T y.
template <typename X, typename Y>
double InnerProduct(const Eigen::MatrixBase<X>& x,
                    const Eigen::MatrixBase<Y>& y) {
  return x.dot(y);
}

/// Returns x^T x, summed over all columns of a matrix.
template <typename X>
double SquaredNorm(const Eigen::MatrixBase<X>& x) {
  return x.squaredNorm();
}

/// Returns ||x||, the Frobenius norm of a matrix.
template <typename X>
double Norm(const Eigen::MatrixBase<X>& x) {
  return x.norm();
}

/// Returns X^T Y, the products of each column of X, which may be sparse, with
/// each column of Y.  X^T X is a Gram matrix.
template <typename X, typename Y>
auto InnerProducts(const Eigen::EigenBase<X>& x, const Eigen::EigenBase<Y>& y) {
  return (x.derived().transpose() * y.derived()).eval();
}

}  // namespace elastimate

#endif  // ELASTIMATE_CORE_ALGEBRA_NODE_SUMS_H_
