#ifndef ELASTIMATE_CORE_ALGEBRA_DENSE_ALGEBRA_H_
#define ELASTIMATE_CORE_ALGEBRA_DENSE_ALGEBRA_H_

#include <Eigen/Core>

#include "elastimate/core/algebra/eigen_abi.h"

namespace elastimate {

// Eigen's decompositions of dense matrices, compiled once: their templates take
// a compiler ten seconds in every source that names them.  Costs are those of
// Eigen's: O(m n^2) for m x n.

/// A = Q R, with min(m, n) orthonormal columns in Q.
struct QrDecomposition {
  Eigen::MatrixXd q;  ///< m x min(m, n)
  Eigen::MatrixXd r;  ///< min(m, n) x n, upper triangular.
};
[[nodiscard]] QrDecomposition DecomposeQr(const Eigen::MatrixXd& a);

/// R alone.
[[nodiscard]] Eigen::MatrixXd TriangularFactor(const Eigen::MatrixXd& a);

/// An orthonormal basis, m x rank, of the space of the columns.  A column whose
/// pivot is not above `threshold` times the largest counts as dependent.
[[nodiscard]] Eigen::MatrixXd OrthonormalBasis(const Eigen::MatrixXd& a,
                                               double threshold);

/// The X that minimises ||A X - B||, by QR with column pivoting; of dependent
/// columns, as above, some get zero.
[[nodiscard]] Eigen::MatrixXd SolveLeastSquares(const Eigen::MatrixXd& a,
                                                const Eigen::MatrixXd& b,
                                                double threshold);
/// Solves as above, with Eigen's threshold, which is that of rounding.
[[nodiscard]] Eigen::MatrixXd SolveLeastSquares(const Eigen::MatrixXd& a,
                                                const Eigen::MatrixXd& b);

/// A = U diag(values) V^T, values in descending order.
struct SingularValueDecomposition {
  Eigen::VectorXd values;  ///< min(m, n)
  Eigen::MatrixXd u;       ///< m x min(m, n)
  Eigen::MatrixXd v;       ///< n x n: the last n - min(m, n) map to zero.
};
[[nodiscard]] SingularValueDecomposition DecomposeSingularValues(
    const Eigen::MatrixXd& a);

/// A X = B X diag(values), values in ascending order, X^T B X = 1.
struct SymmetricEigenDecomposition {
  Eigen::VectorXd values;
  Eigen::MatrixXd vectors;
};
/// Decomposes a symmetric matrix, of which the lower triangle is read; B = 1.
[[nodiscard]] SymmetricEigenDecomposition DecomposeSymmetric(
    const Eigen::MatrixXd& a);
/// Decomposes a symmetric A beside a positive definite B, of which the lower
/// triangles are read.
[[nodiscard]] SymmetricEigenDecomposition DecomposeSymmetric(
    const Eigen::MatrixXd& a, const Eigen::MatrixXd& b);

/// Inverts a square matrix; the entries are not finite when it is singular.
[[nodiscard]] Eigen::MatrixXd Inverse(const Eigen::MatrixXd& a);

}  // namespace elastimate

#endif  // ELASTIMATE_CORE_ALGEBRA_DENSE_ALGEBRA_H_
