#include "elastimate/core/algebra/row_block_qr.h"

#include <gtest/gtest.h>

#include "tests/core/random_values.h"

namespace elastimate {
namespace {

using testing::RandomMatrix;

Eigen::MatrixXd TriangleOf(const Eigen::MatrixXd& matrix) {
  RowBlockQr qr(matrix.cols());
  for (Eigen::Index i = 0; i < matrix.rows(); ++i) {
    qr.NextRow() = matrix.row(i);
  }
  return qr.Triangle();
}

// A block has 512 rows, so full blocks, parts of one, and several are tested.
TEST(RowBlockQr, HasTheGramMatrixOfAllRows) {
  for (const Eigen::Index rows : {4, 511, 512, 513, 3000}) {
    SCOPED_TRACE(rows);
    const Eigen::MatrixXd matrix = RandomMatrix(rows, 4, 1);
    const Eigen::MatrixXd triangle = TriangleOf(matrix);
    EXPECT_TRUE(triangle.isUpperTriangular());
    EXPECT_TRUE((triangle.transpose() * triangle)
                    .isApprox(matrix.transpose() * matrix, 1e-13));
  }
}

// A Gram matrix would have lost this difference, since it has the square of the
// condition number.
TEST(RowBlockQr, KeepsASmallDifferenceOfColumns) {
  Eigen::MatrixXd matrix = RandomMatrix(2000, 2, 2);
  const Eigen::VectorXd difference = 1e-10 * matrix.col(1);
  matrix.col(1) = matrix.col(0) + difference;
  const Eigen::VectorXd rest =
      difference - matrix.col(0) * (matrix.col(0).dot(difference) /
                                    matrix.col(0).squaredNorm());
  EXPECT_NEAR(std::abs(TriangleOf(matrix)(1, 1)) / rest.norm(), 1, 1e-4);
}

TEST(RowBlockQr, HasZeroRowsWhereThereWereFew) {
  RowBlockQr qr(3);
  qr.NextRow() << 3, 4, 0;
  const Eigen::MatrixXd triangle = qr.Triangle();
  EXPECT_EQ(triangle.rows(), 3);
  EXPECT_NEAR(std::abs(triangle(0, 0)), 3, 1e-15);
  EXPECT_NEAR(triangle.norm(), 5, 1e-14);
  EXPECT_LT(triangle.bottomRows(2).norm(), 1e-15);
}

}  // namespace
}  // namespace elastimate
