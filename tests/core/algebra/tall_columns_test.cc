#include "elastimate/core/algebra/tall_columns.h"

#include <gtest/gtest.h>

#include "tests/core/random_values.h"

namespace elastimate {
namespace {

using testing::RandomMatrix;

// More rows than one block has.
constexpr Eigen::Index kManyRows = 50001;

TEST(TallColumns, BlocksOfRowsCoverEachRowOnce) {
  Eigen::VectorXi visits = Eigen::VectorXi::Zero(kManyRows);
  ForRowBlocks(kManyRows, [&](Eigen::Index first, Eigen::Index count) {
    visits.segment(first, count).array() += 1;
  });
  EXPECT_TRUE((visits.array() == 1).all());
}

TEST(TallColumns, HaveTheProductsAndMagnitudesOfWholeColumns) {
  const Eigen::MatrixXd a = RandomMatrix(kManyRows, 2, 1);
  const Eigen::MatrixXd b = RandomMatrix(kManyRows, 2, 2);
  EXPECT_TRUE(
      ColumnProducts(a, b).isApprox(a.cwiseProduct(b).colwise().sum(), 1e-12));
  EXPECT_TRUE(
      ColumnMagnitudes(a).isApprox(a.cwiseAbs().colwise().sum(), 1e-12));
  EXPECT_TRUE(ColumnMagnitudes(Eigen::MatrixXd(0, 2)).isZero(0));
}

TEST(TallColumns, AreScaledAndAddedByColumns) {
  const Eigen::MatrixXd a = RandomMatrix(kManyRows, 2, 3);
  const Eigen::MatrixXd b = RandomMatrix(kManyRows, 2, 4);
  const Eigen::RowVector2d factors(2, -0.5);
  Eigen::MatrixXd sum = a;
  Scale(sum, factors);
  AddTo(sum, b);
  AddTo(sum, b, factors);
  EXPECT_TRUE(
      sum.isApprox(Eigen::MatrixXd((a + b) * factors.asDiagonal()) + b, 1e-14));
}

}  // namespace
}  // namespace elastimate
