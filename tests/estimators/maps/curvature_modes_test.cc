#include "elastimate/estimators/maps/curvature_modes.h"

#include <gtest/gtest.h>

#include <Eigen/Core>
#include <Eigen/Eigenvalues>
#include <Eigen/LU>
#include <Eigen/QR>
#include <cmath>

namespace elastimate {
namespace {

// A matrix whose eigenvalues fall off as those of smoothing problems do.
Eigen::MatrixXd Decaying(Eigen::Index n) {
  const Eigen::MatrixXd root =
      Eigen::MatrixXd::NullaryExpr(n, n, [n](Eigen::Index i, Eigen::Index j) {
        return std::cos(double(1 + i) * double(1 + j) * double(n + i * j));
      });
  const Eigen::MatrixXd q =
      Eigen::HouseholderQR<Eigen::MatrixXd>(root).householderQ();
  const Eigen::VectorXd values =
      Eigen::VectorXd::LinSpaced(n, 1, double(n)).array().pow(-3);
  return q * values.asDiagonal() * q.transpose();
}

TEST(CurvatureModes, KnowDeterminantTraceAndInverse) {
  constexpr Eigen::Index kSize = 700;
  const Eigen::MatrixXd h = Decaying(kSize);
  CurvatureModes modes(kSize);
  Eigen::Index num_products = 0;
  constexpr double kRatio = 1e4;
  modes.AddUntil(0.3 / kRatio, [&](const Eigen::MatrixXd& x) {
    num_products += x.cols();
    return Eigen::MatrixXd(h * x);
  });
  EXPECT_LT(num_products, 64 + 20 * 32 + 1);
  const Eigen::MatrixXd shifted =
      Eigen::MatrixXd::Identity(kSize, kSize) + kRatio * h;
  const double log_determinant =
      shifted.partialPivLu().matrixLU().diagonal().array().abs().log().sum();
  EXPECT_NEAR(modes.LogDeterminant(kRatio), log_determinant,
              0.01 * log_determinant);
  const Eigen::MatrixXd inverse = shifted.inverse();
  const double number = double(kSize) - inverse.trace();
  EXPECT_NEAR(modes.EffectiveNumber(kRatio), number, 0.02 * number);
  const Eigen::MatrixXd preconditioned = modes.Solve(kRatio, shifted / kRatio);
  EXPECT_LT(
      (preconditioned - Eigen::MatrixXd::Identity(kSize, kSize)).operatorNorm(),
      0.3);
}

// With few modes kept, most of the effective number lies beside them.
TEST(CurvatureModes, KnowWhatIsBesideThem) {
  constexpr Eigen::Index kSize = 700;
  const Eigen::MatrixXd h = Decaying(kSize);
  const ColumnOperator multiply = [&](const Eigen::MatrixXd& x) {
    return Eigen::MatrixXd(h * x);
  };
  CurvatureModes modes(kSize);
  modes.AddUntil(1e9, multiply);
  const double ratio = 100 / modes.Values()(modes.Values().size() - 1);
  const Eigen::MatrixXd shifted =
      Eigen::MatrixXd::Identity(kSize, kSize) + ratio * h;
  const double number = double(kSize) - shifted.inverse().trace();
  EXPECT_GT(number, 3 * double(modes.Values().size()));
  EXPECT_NEAR(modes.EffectiveNumber(ratio), number, 0.05 * number);
  const double log_determinant =
      shifted.partialPivLu().matrixLU().diagonal().array().abs().log().sum();
  EXPECT_NEAR(modes.LogDeterminant(ratio), log_determinant,
              0.05 * log_determinant);
}

TEST(CurvatureModes, AreExactWhereAllAreAskedFor) {
  constexpr Eigen::Index kSize = 40;
  Eigen::MatrixXd h = Decaying(kSize);
  // A direction of no curvature does no harm.
  const Eigen::VectorXd ones = Eigen::VectorXd::Ones(kSize).normalized();
  h -= ones * (ones.transpose() * h).eval();
  h -= (h * ones).eval() * ones.transpose();
  CurvatureModes modes(kSize);
  modes.AddUntil(
      0, [&](const Eigen::MatrixXd& x) { return Eigen::MatrixXd(h * x); });
  const Eigen::MatrixXd shifted =
      Eigen::MatrixXd::Identity(kSize, kSize) / 1e6 + h;
  EXPECT_LT(
      (modes.Solve(1e6, shifted) - Eigen::MatrixXd::Identity(kSize, kSize))
          .norm(),
      1e-5);
}

// Few measurements make an H of low rank.
TEST(CurvatureModes, StopAtTheRank) {
  const Eigen::MatrixXd g = Decaying(300).leftCols(5);
  CurvatureModes modes(300);
  modes.AddUntil(0, [&](const Eigen::MatrixXd& x) {
    return Eigen::MatrixXd(g * (g.transpose() * x));
  });
  EXPECT_LE(modes.Size(), 64);
  EXPECT_TRUE(modes.HasAll());
  const Eigen::MatrixXd shifted =
      Eigen::MatrixXd::Identity(300, 300) + 1e4 * g * g.transpose();
  EXPECT_NEAR(
      modes.LogDeterminant(1e4),
      shifted.partialPivLu().matrixLU().diagonal().array().abs().log().sum(),
      1e-4);
}

TEST(CurvatureModes, AreThoseOfARoot) {
  const Eigen::MatrixXd g = Decaying(40).leftCols(12);
  const CurvatureModes modes = CurvatureModes::OfRoot(g);
  ASSERT_EQ(modes.Size(), 12);
  EXPECT_LT((modes.Vectors() * modes.Values().asDiagonal() *
                 modes.Vectors().transpose() -
             g * g.transpose())
                .norm(),
            1e-12 * g.squaredNorm());
  const Eigen::MatrixXd shifted =
      Eigen::MatrixXd::Identity(40, 40) + 1e4 * g * g.transpose();
  EXPECT_NEAR(
      modes.LogDeterminant(1e4),
      shifted.partialPivLu().matrixLU().diagonal().array().abs().log().sum(),
      1e-6);
}

}  // namespace
}  // namespace elastimate
