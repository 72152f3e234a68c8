#include "elastimate/core/algebra/dense_algebra.h"

#include <gtest/gtest.h>

namespace elastimate {
namespace {

// The third column differs from the second by 1e-9 only.  Coefficients of 1e9
// would fit that difference.
TEST(SolveLeastSquares, LeavesOutColumnsThatAreNearlyDependent) {
  Eigen::MatrixXd a(4, 3);
  a << 1, 1, 1,  //
      1, 2, 2,   //
      1, 3, 3,   //
      1, 4, 4 + 1e-9;
  const Eigen::Vector4d b(1, 2, 3, 5);
  EXPECT_GT(SolveLeastSquares(a, b, 1e-14).cwiseAbs().maxCoeff(), 1e8);
  const Eigen::MatrixXd x = SolveLeastSquares(a, b, 1e-6);
  EXPECT_LT(x.cwiseAbs().maxCoeff(), 10);
  // Without the third column, the residual is that of a straight line through
  // 1, 2, 3, 5 over 1, 2, 3, 4.
  EXPECT_NEAR((a * x - b).squaredNorm(), 0.3, 1e-6);
}

// 120 columns are enough for LAPACK.
TEST(DecomposeSymmetric, TakesAMatrixWithoutRows) {
  const Eigen::MatrixXd none(0, 0);
  EXPECT_EQ(DecomposeSymmetric(none).values.size(), 0);
  EXPECT_EQ(DecomposeSymmetric(none, none).vectors.size(), 0);
}

TEST(DecomposeSymmetric, DecomposesLargeMatrices) {
  const Eigen::MatrixXd a = Eigen::MatrixXd::Random(120, 150);
  const Eigen::MatrixXd gram = a * a.transpose();
  EXPECT_LT((Product(a, a.transpose()) - gram).norm(), 1e-12 * gram.norm());
  EXPECT_LT((ProductOfTransposed(a, a) - a.transpose() * a).norm(),
            1e-12 * gram.norm());
  const SymmetricEigenDecomposition decomposition =
      DecomposeSymmetric(gram.triangularView<Eigen::Lower>());
  const Eigen::MatrixXd& x = decomposition.vectors;
  EXPECT_LT((gram * x - x * decomposition.values.asDiagonal()).norm(),
            1e-12 * gram.norm());
  EXPECT_LT((x.transpose() * x - Eigen::MatrixXd::Identity(120, 120)).norm(),
            1e-11);
  for (Eigen::Index i = 1; i < 120; ++i) {
    EXPECT_LE(decomposition.values(i - 1), decomposition.values(i));
  }
}

}  // namespace
}  // namespace elastimate
