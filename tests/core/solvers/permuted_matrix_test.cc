#include "elastimate/core/solvers/permuted_matrix.h"

#include <gtest/gtest.h>

#include <Eigen/SparseCore>
#include <array>

namespace elastimate {
namespace {

using LowerTriangle =
    Eigen::SparseMatrix<double, Eigen::ColMajor, std::int64_t>;

Eigen::MatrixXd Dense(const SymmetricPattern& pattern,
                      const Eigen::VectorXd& values) {
  const Eigen::Map<const LowerTriangle> lower(
      pattern.Size(), pattern.Size(), values.size(),
      pattern.column_start.data(), pattern.row.data(), values.data());
  return lower.selfadjointView<Eigen::Lower>() *
         Eigen::MatrixXd::Identity(pattern.Size(), pattern.Size());
}

TEST(PermutedMatrix, HasTheValuesOfTheMatrix) {
  const SymmetricPattern pattern = {{0, 3, 4, 6, 7}, {0, 1, 3, 1, 2, 3, 3}};
  const std::array<std::int64_t, 4> order = {2, 0, 3, 1};
  PermutedMatrix permuted(pattern, order.data());
  for (const double factor : {1.0, -2.0}) {
    Eigen::VectorXd values(7);
    values << 1, 2, 3, 4, 5, 6, 7;
    values *= factor;
    Eigen::Matrix4d a;
    a << 1, 2, 0, 3,  //
        2, 4, 0, 0,   //
        0, 0, 5, 6,   //
        3, 0, 6, 7;
    Eigen::Matrix4d expected;
    for (int i = 0; i < 4; ++i) {
      for (int j = 0; j < 4; ++j) {
        expected(i, j) = factor * a(order[i], order[j]);
      }
    }
    EXPECT_EQ(Dense(permuted.Pattern(), permuted.ValuesFrom(values)), expected);
  }
}

}  // namespace
}  // namespace elastimate
