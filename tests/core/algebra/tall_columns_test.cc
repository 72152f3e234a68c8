#include "elastimate/core/algebra/tall_columns.h"

#include <gtest/gtest.h>
#include <omp.h>

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

TEST(TallColumns, HaveTheSameBitsForAnyNumberOfThreads) {
  // Sums of several blocks depend on the order in which the blocks are added.
  const Eigen::MatrixXd a = RandomMatrix(3 * kManyRows, 2, 5);
  const Eigen::MatrixXd b = RandomMatrix(3 * kManyRows, 2, 6);
  const Eigen::RowVector2d factors(1.0 / 3, -0.7);
  const auto changed = [&] {
    Eigen::MatrixXd columns = a;
    Scale(columns, factors);
    AddTo(columns, b);
    AddTo(columns, b, factors);
    return columns;
  };
  const int num_threads = omp_get_max_threads();
  omp_set_num_threads(1);
  const Eigen::RowVectorXd products = ColumnProducts(a, b);
  const Eigen::RowVectorXd magnitudes = ColumnMagnitudes(a);
  const Eigen::MatrixXd columns = changed();
  for (const int num : {2, 5}) {
    omp_set_num_threads(num);
    EXPECT_EQ(ColumnProducts(a, b), products);
    EXPECT_EQ(ColumnMagnitudes(a), magnitudes);
    EXPECT_EQ(changed(), columns);
  }
  omp_set_num_threads(num_threads);
}

}  // namespace
}  // namespace elastimate
