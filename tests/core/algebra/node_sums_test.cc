#include "elastimate/core/algebra/node_sums.h"

#include <gtest/gtest.h>

#include <Eigen/SparseCore>
#include <cmath>

#include "tests/core/random_values.h"

namespace elastimate {
namespace {

using testing::RandomMatrix;

TEST(NodeSums, AreThoseOfAllRows) {
  const Eigen::MatrixXd x = RandomMatrix(100, 3, 1);
  const Eigen::MatrixXd y = RandomMatrix(100, 2, 2);
  Eigen::MatrixXd products = Eigen::MatrixXd::Zero(3, 2);
  double squares = 0;
  for (Eigen::Index row = 0; row < x.rows(); ++row) {
    for (Eigen::Index i = 0; i < x.cols(); ++i) {
      squares += x(row, i) * x(row, i);
      for (Eigen::Index j = 0; j < y.cols(); ++j) {
        products(i, j) += x(row, i) * y(row, j);
      }
    }
  }
  EXPECT_TRUE(InnerProducts(x, y).isApprox(products, 1e-14));
  EXPECT_NEAR(InnerProduct(x.col(1), y.col(0)), products(1, 0), 1e-13);
  EXPECT_NEAR(SquaredNorm(x), squares, 1e-12);
  EXPECT_NEAR(Norm(x), std::sqrt(squares), 1e-13);
  const Eigen::SparseMatrix<double> sparse = x.sparseView();
  EXPECT_TRUE(InnerProducts(sparse, y.col(1)).isApprox(products.col(1), 1e-14));
}

}  // namespace
}  // namespace elastimate
