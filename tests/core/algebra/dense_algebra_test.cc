#include "elastimate/core/algebra/dense_algebra.h"

#include <gtest/gtest.h>

namespace elastimate {
namespace {

// The third column is the second but for 1e-9: coefficients of 1e9 would fit
// what differs.
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
  // The residual of a straight line is left: that of 1, 2, 3, 5 on 1, 2, 3, 4.
  EXPECT_NEAR((a * x - b).squaredNorm(), 0.3, 1e-6);
}

}  // namespace
}  // namespace elastimate
