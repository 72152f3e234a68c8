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

}  // namespace
}  // namespace elastimate
