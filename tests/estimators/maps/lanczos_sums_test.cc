#include "elastimate/estimators/maps/lanczos_sums.h"

#include <gtest/gtest.h>

#include <Eigen/Core>
#include <Eigen/Eigenvalues>
#include <cmath>

namespace elastimate {
namespace {

// A symmetric matrix with eigenvalues from 0 to `largest`.
Eigen::MatrixXd WithEigenvalues(Eigen::Index n, double largest) {
  const Eigen::MatrixXd root =
      Eigen::MatrixXd::NullaryExpr(n, n, [n](Eigen::Index i, Eigen::Index j) {
        return std::sin(double(2 + i) * double(1 + j) * double(n + i * j));
      });
  Eigen::MatrixXd gram = root * root.transpose();
  const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> solver(gram);
  return solver.eigenvectors() *
         Eigen::VectorXd::LinSpaced(n, 0, largest).asDiagonal() *
         solver.eigenvectors().transpose();
}

TEST(LanczosSums, AreQuadraticFormsOfFunctions) {
  constexpr Eigen::Index kSize = 120;
  const Eigen::MatrixXd h = WithEigenvalues(kSize, 30);
  Eigen::MatrixXd vectors(kSize, 2);
  vectors << Eigen::VectorXd::Ones(kSize), Eigen::VectorXd::Zero(kSize);
  int num_products = 0;
  const LanczosSums sums(
      [&](const Eigen::MatrixXd& x) {
        ++num_products;
        return Eigen::MatrixXd(h * x);
      },
      vectors, 20);
  EXPECT_LE(num_products, 20);
  const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> solver(h);
  const Eigen::ArrayXd squares =
      (solver.eigenvectors().transpose() * vectors.col(0)).array().square();
  const Eigen::ArrayXd values = solver.eigenvalues().array().max(0);
  const double exact = (squares * values.log1p()).sum();
  EXPECT_NEAR(sums.Of(0, [](double x) { return std::log1p(x); }), exact,
              1e-4 * exact);
  EXPECT_NEAR(sums.Of(0, [](double x) { return x; }), (squares * values).sum(),
              1e-10 * (squares * values).sum());
  EXPECT_EQ(sums.Of(1, [](double x) { return 1 + x; }), 0);
}

// Vectors in an invariant space end the iteration early.
TEST(LanczosSums, AreExactOfFewEigenvalues) {
  constexpr Eigen::Index kSize = 50;
  Eigen::VectorXd diagonal = Eigen::VectorXd::Constant(kSize, 3);
  diagonal.tail(20).setConstant(7);
  diagonal.head(5).setZero();
  const LanczosSums sums(
      [&](const Eigen::MatrixXd& x) {
        return Eigen::MatrixXd(diagonal.asDiagonal() * x);
      },
      Eigen::MatrixXd::Ones(kSize, 1), 10);
  EXPECT_NEAR(sums.Of(0, [](double x) { return 1 / (1 + x); }),
              5 + 25 / 4.0 + 20 / 8.0, 1e-10);
}

}  // namespace
}  // namespace elastimate
