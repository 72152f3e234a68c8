#ifndef ELASTIMATE_CORE_ALGEBRA_DENSE_ALGEBRA_H_
#define ELASTIMATE_CORE_ALGEBRA_DENSE_ALGEBRA_H_

#include <Eigen/Core>

#include "elastimate/core/algebra/eigen_abi.h"

namespace elastimate {

// Eigen's decompositions of dense matrices, compiled once: their templates take
// a compiler ten seconds in every source that names them.  Costs are those of
// Eigen's: O(m n^2) for m x n.

/// Returns A B, for m x k and k x n.  Large products are several times as fast
/// by BLAS as by Eigen, which is compiled for any processor.
[[nodiscard]] Eigen::MatrixXd Product(
    const Eigen::Ref<const Eigen::MatrixXd>& a, const Eigen::MatrixXd& b);
/// Returns A^T B likewise, for k x m and k x n.
[[nodiscard]] Eigen::MatrixXd ProductOfTransposed(
    const Eigen::Ref<const Eigen::MatrixXd>& a, const Eigen::MatrixXd& b);

/// A = Q R, with min(m, n) orthonormal columns in Q.
struct QrDecomposition {
  Eigen::MatrixXd q;  ///< m x min(m, n)
  Eigen::MatrixXd r;  ///< min(m, n) x n, upper triangular.
};
[[nodiscard]] QrDecomposition DecomposeQr(const Eigen::MatrixXd& a);

/// Returns R alone.
[[nodiscard]] Eigen::MatrixXd TriangularFactor(const Eigen::MatrixXd& a);

/// Returns an orthonormal basis, m x rank, of the space that the columns span.
/// A column counts as dependent where its pivot is at most `threshold` times
/// the largest pivot.
[[nodiscard]] Eigen::MatrixXd OrthonormalBasis(const Eigen::MatrixXd& a,
                                               double threshold);

/// Returns an X that minimises ||A X - B||, by QR with column pivoting. Rows of
/// X that belong to dependent columns of A (see OrthonormalBasis) are zero.
[[nodiscard]] Eigen::MatrixXd SolveLeastSquares(const Eigen::MatrixXd& a,
                                                const Eigen::MatrixXd& b,
                                                double threshold);
/// This overload takes Eigen's threshold, which counts as dependent what
/// rounding cannot tell from dependence.
[[nodiscard]] Eigen::MatrixXd SolveLeastSquares(const Eigen::MatrixXd& a,
                                                const Eigen::MatrixXd& b);

/// A decomposition A = U diag(values) V^T has its values in descending order.
struct SingularValueDecomposition {
  Eigen::VectorXd values;  ///< min(m, n)
  Eigen::MatrixXd u;       ///< m x min(m, n)
  Eigen::MatrixXd v;       ///< n x n: the last n - min(m, n) map to zero.
};
[[nodiscard]] SingularValueDecomposition DecomposeSingularValues(
    const Eigen::MatrixXd& a);

/// A decomposition A X = B X diag(values) has its values in ascending order,
/// and X^T B X = 1.
struct SymmetricEigenDecomposition {
  Eigen::VectorXd values;
  Eigen::MatrixXd vectors;
};
/// Decomposes a symmetric A for B = 1; only its lower triangle is read.  A
/// large one is left to LAPACK, for the speed of its BLAS.  Throws
/// std::bad_alloc when there is not enough memory.
[[nodiscard]] SymmetricEigenDecomposition DecomposeSymmetric(
    const Eigen::MatrixXd& a);
/// Decomposes a symmetric A for a positive definite B; only the lower triangles
/// of both are read.
[[nodiscard]] SymmetricEigenDecomposition DecomposeSymmetric(
    const Eigen::MatrixXd& a, const Eigen::MatrixXd& b);

/// Inverts a square matrix.  Entries are not finite when it is singular.
[[nodiscard]] Eigen::MatrixXd Inverse(const Eigen::MatrixXd& a);

}  // namespace elastimate

#endif  // ELASTIMATE_CORE_ALGEBRA_DENSE_ALGEBRA_H_
