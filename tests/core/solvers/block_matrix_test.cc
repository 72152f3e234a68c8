#include "elastimate/core/solvers/block_matrix.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numeric>
#include <random>
#include <string>
#include <tuple>

#include "tests/core/random_values.h"

namespace elastimate {
namespace {

using testing::RandomMatrix;

class BlocksOfSize : public ::testing::TestWithParam<std::tuple<int, int>> {
 protected:
  // Makes a matrix with about three blocks in each row, and none in some.
  BlocksOfSize() {
    std::tie(a_.block_rows, a_.block_columns) = GetParam();
    a_.num_columns = Eigen::Index{kBlockColumns} * a_.block_columns;
    std::minstd_rand random(1);
    std::uniform_real_distribution<float> entry(-1, 1);
    a_.start.push_back(0);
    for (int i = 0; i < kBlockRows; ++i) {
      for (int j = 0; j < kBlockColumns; ++j) {
        if (i % 10 != 3 && random() % 17 < 3) {
          a_.column.push_back(j);
          for (int k = 0; k < a_.block_rows * a_.block_columns; ++k) {
            a_.entries.push_back(entry(random));
          }
        }
      }
      a_.start.push_back(Eigen::Index(a_.column.size()));
    }
  }

  static Eigen::MatrixXd Dense(const BlockMatrix& a) {
    Eigen::MatrixXd dense = Eigen::MatrixXd::Zero(a.NumRows(), a.num_columns);
    for (Eigen::Index i = 0; i < a.NumBlockRows(); ++i) {
      for (Eigen::Index k = a.start[i]; k < a.start[i + 1]; ++k) {
        for (int r = 0; r < a.block_rows; ++r) {
          for (int c = 0; c < a.block_columns; ++c) {
            dense(a.block_rows * i + r, a.block_columns * a.column[k] + c) =
                a.entries[(k * a.block_columns + c) * a.block_rows + r];
          }
        }
      }
    }
    return dense;
  }

  // Enough rows for several threads.
  static constexpr int kBlockRows = 5000;
  static constexpr int kBlockColumns = 17;
  BlockMatrix a_;
};

using BlocksOfInterpolations = BlocksOfSize;

std::string NameOfSize(
    const ::testing::TestParamInfo<std::tuple<int, int>>& info) {
  return std::to_string(std::get<0>(info.param)) + "x" +
         std::to_string(std::get<1>(info.param));
}

INSTANTIATE_TEST_SUITE_P(Sizes, BlocksOfSize,
                         ::testing::Values(std::tuple(1, 1), std::tuple(2, 2),
                                           std::tuple(2, 3), std::tuple(3, 3),
                                           std::tuple(3, 6), std::tuple(6, 6)),
                         NameOfSize);
INSTANTIATE_TEST_SUITE_P(Sizes, BlocksOfInterpolations,
                         ::testing::Values(std::tuple(1, 1), std::tuple(2, 3),
                                           std::tuple(3, 3), std::tuple(3, 6),
                                           std::tuple(6, 6)),
                         NameOfSize);

TEST_P(BlocksOfSize, AreMultipliedAsADenseMatrix) {
  for (const int num_columns : {0, 1, 4, 7}) {
    const Eigen::MatrixXd x = RandomMatrix(a_.num_columns, num_columns, 2);
    const Eigen::MatrixXd expected = Dense(a_) * x;
    EXPECT_LE((Multiply(a_, x) - expected).norm(), 1e-13 * expected.norm());
  }
}

TEST_P(BlocksOfSize, AreMultipliedWithTheirRest) {
  // Entries of 24 bits below those of a.
  a_.rest.resize(a_.entries.size());
  std::transform(a_.entries.rbegin(), a_.entries.rend(), a_.rest.begin(),
                 [](float entry) { return std::ldexp(entry, -25); });
  BlockMatrix rest = a_;
  rest.entries = a_.rest;
  for (const int num_columns : {0, 1, 4, 7}) {
    const Eigen::MatrixXd x = RandomMatrix(a_.num_columns, num_columns, 2);
    const Eigen::MatrixXd expected = (Dense(a_) + Dense(rest)) * x;
    EXPECT_LE((MultiplyAccurately(a_, x) - expected).norm(),
              1e-13 * expected.norm());
  }
}

TEST_P(BlocksOfSize, HandOutSomeOfTheirRows) {
  a_.rest = a_.entries;
  const Eigen::MatrixXd dense = Dense(a_);
  for (const int first : {0, 1, kBlockRows}) {
    for (const int end : {first, kBlockRows}) {
      const BlockMatrix some = RowsOf(a_, first, end);
      EXPECT_EQ(Dense(some), dense.middleRows(a_.block_rows * first,
                                              a_.block_rows * (end - first)));
      EXPECT_EQ(some.rest, some.entries);
    }
  }
}

TEST_P(BlocksOfInterpolations, AreMultipliedTransposed) {
  const BlocksByColumn by_column = OrderByColumn(a_);
  for (const int num_columns : {0, 1, 4}) {
    const Eigen::MatrixXd x = RandomMatrix(a_.NumRows(), num_columns, 3);
    const Eigen::MatrixXd expected = Dense(a_).transpose() * x;
    EXPECT_LE((MultiplyTransposed(a_, by_column, x) - expected).norm(),
              1e-13 * expected.norm());
  }
}

TEST(BlockMatrix, HandsOutTheBlocksOnItsDiagonal) {
  BlockMatrix a;
  a.block_rows = 2;
  a.block_columns = 2;
  a.num_columns = 6;
  a.start = {0, 2, 3, 3};
  a.column = {1, 0, 0};
  a.entries = {9, 9, 9, 9, 1, 2, 3, 4, 8, 8, 8, 8};
  Eigen::MatrixXd expected = Eigen::MatrixXd::Zero(2, 6);
  expected.leftCols<2>() << 1, 3, 2, 4;
  EXPECT_EQ(DiagonalBlocks(a), expected);
}

}  // namespace
}  // namespace elastimate
