#include "elastimate/estimators/plan/expected_errors.h"

#include <gtest/gtest.h>

#include <Eigen/LU>
#include <cmath>

namespace elastimate {
namespace {

TEST(ExpectedErrors, AreThoseOfTheInverse) {
  const Eigen::Matrix3d information =
      (Eigen::Matrix3d() << 4, 1, 0.5, 1, 3, -1, 0.5, -1, 9).finished();
  const Eigen::Matrix3d covariance = information.inverse();
  const ExpectedErrors errors = ExpectedErrors::Of(information);
  EXPECT_EQ(errors.NumUndetermined(), 0);
  const Eigen::VectorXd of_parameters = errors.OfParameters();
  for (int i = 0; i < 3; ++i) {
    EXPECT_NEAR(of_parameters(i), std::sqrt(covariance(i, i)), 1e-12);
  }
  const Eigen::Vector3d c(1, -2, 0.3);
  EXPECT_NEAR(errors.Along(c), std::sqrt(c.dot(covariance * c)), 1e-12);
  // No combination of norm 1 is worse than the first direction.
  EXPECT_GE(errors.standard_errors(0), errors.Along(c.normalized()));
  EXPECT_NEAR(errors.Along(errors.directions.col(0)), errors.standard_errors(0),
              1e-12);
}

TEST(ExpectedErrors, AreInfiniteOfWhatTakesPartInAnUndeterminedDirection) {
  // The information is on the difference of the first two parameters, and on
  // the third one.
  const Eigen::Vector3d difference(1, -1, 0);
  const Eigen::Matrix3d information =
      25 * difference * difference.transpose() +
      Eigen::Vector3d(0, 0, 4).asDiagonal().toDenseMatrix();
  const ExpectedErrors errors = ExpectedErrors::Of(information);
  ASSERT_EQ(errors.NumUndetermined(), 1);
  EXPECT_NEAR(errors.directions.col(0).dot(Eigen::Vector3d(1, 1, 0)),
              std::sqrt(2), 1e-12);
  const Eigen::VectorXd of_parameters = errors.OfParameters();
  EXPECT_TRUE(std::isinf(of_parameters(0)));
  EXPECT_TRUE(std::isinf(of_parameters(1)));
  EXPECT_NEAR(of_parameters(2), 0.5, 1e-12);
  EXPECT_NEAR(errors.Along(difference), std::sqrt(4) / (5 * 2), 1e-12);
}

TEST(ExpectedErrors, OfNothingAreInfinite) {
  const ExpectedErrors errors = ExpectedErrors::Of(Eigen::Matrix2d::Zero());
  EXPECT_EQ(errors.NumUndetermined(), 2);
  EXPECT_TRUE(std::isinf(errors.OfParameters()(1)));
  EXPECT_FALSE(errors.AreSmallerThan(errors));
}

TEST(ExpectedErrors, AreSmallerWithFewerUndeterminedDirections) {
  const auto of = [](double a, double b) {
    return ExpectedErrors::Of(Eigen::Vector2d(a, b).asDiagonal());
  };
  EXPECT_TRUE(of(1e-4, 1e-4).AreSmallerThan(of(0, 1e4)));
  EXPECT_FALSE(of(0, 1e4).AreSmallerThan(of(1e-4, 1e-4)));
  EXPECT_TRUE(of(0, 2).AreSmallerThan(of(1, 0)));
  EXPECT_TRUE(of(2, 5).AreSmallerThan(of(9, 1)));
}

}  // namespace
}  // namespace elastimate
