#include "elastimate/core/solvers/divided_matrix.h"

#include <gtest/gtest.h>

#include <memory>
#include <utility>
#include <vector>

#include "tests/core/random_values.h"

namespace elastimate {
namespace {

// Has the rows of all ranks.
class WholeVector : public Halo {
 public:
  WholeVector(Eigen::Index first, Eigen::MatrixXd all, std::vector<int> others)
      : first_(first), all_(std::move(all)), others_(std::move(others)) {}

  Eigen::MatrixXd WithOthers(const Eigen::MatrixXd& own) const override {
    Eigen::MatrixXd with(own.rows() + Eigen::Index(others_.size()), own.cols());
    with << own, all_(others_, Eigen::all);
    return with;
  }
  // As if the other ranks held the rows of `all` for each own row.
  Eigen::MatrixXd Added(const Eigen::MatrixXd& with_others) const override {
    const Eigen::Index num_own =
        with_others.rows() - Eigen::Index(others_.size());
    return with_others.topRows(num_own) + all_.middleRows(first_, num_own);
  }

 private:
  Eigen::Index first_;
  Eigen::MatrixXd all_;
  std::vector<int> others_;
};

// Rows 2 and 3 of a matrix of 6 columns.
BlockMatrix MiddleRows() {
  BlockMatrix rows;
  rows.num_columns = 6;
  rows.start = {0, 4, 6};
  rows.column = {5, 0, 2, 3, 3, 5};
  rows.entries = {1, 2, 3, 4, 5, 6};
  rows.rest = {0, 0, 0, 0, 0, 0.25F};
  return rows;
}

TEST(DividedMatrix, NumbersItsOwnColumnsFirst) {
  BlockMatrix rows = MiddleRows();
  EXPECT_EQ(NumberOwnColumnsFirst(2, 2, rows), (std::vector<int>{0, 5}));
  EXPECT_EQ(rows.column, (std::vector<int>{3, 2, 0, 1, 1, 3}));
  EXPECT_EQ(rows.num_columns, 4);
}

TEST(DividedMatrix, MultipliesRowsOfOtherRanks) {
  const Eigen::MatrixXd all = testing::RandomMatrix(6, 2, 1);
  DividedMatrix a = {MiddleRows(), nullptr};
  const Eigen::MatrixXd expected = Multiply(a.rows, all);
  const Eigen::MatrixXd accurate = MultiplyAccurately(a.rows, all);
  ASSERT_NE(accurate, expected);
  a.halo = std::make_shared<WholeVector>(2, all,
                                         NumberOwnColumnsFirst(2, 2, a.rows));
  EXPECT_TRUE(Multiply(a, all.middleRows(2, 2)).isApprox(expected, 1e-14));
  EXPECT_TRUE(
      MultiplyAccurately(a, all.middleRows(2, 2)).isApprox(accurate, 1e-14));
}

TEST(DividedMatrix, AddsWhatOtherRanksHave) {
  const Eigen::MatrixXd all = testing::RandomMatrix(6, 2, 1);
  DividedMatrix a = {MiddleRows(), nullptr};
  const Eigen::MatrixXd x = testing::RandomMatrix(2, 2, 2);
  const Eigen::MatrixXd expected =
      MultiplyTransposed(a.rows, OrderByColumn(a.rows), x).middleRows(2, 2) +
      all.middleRows(2, 2);
  a.halo = std::make_shared<WholeVector>(2, all,
                                         NumberOwnColumnsFirst(2, 2, a.rows));
  EXPECT_TRUE(MultiplyTransposed(a, OrderByColumn(a.rows), x)
                  .isApprox(expected, 1e-14));
}

TEST(DividedMatrix, IsWholeWithoutAHalo) {
  const DividedMatrix a = {MiddleRows(), nullptr};
  const Eigen::MatrixXd x = testing::RandomMatrix(6, 1, 1);
  EXPECT_EQ(Multiply(a, x), Multiply(a.rows, x));
}

}  // namespace
}  // namespace elastimate
