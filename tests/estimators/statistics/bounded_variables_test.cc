#include "elastimate/estimators/statistics/bounded_variables.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

namespace elastimate {
namespace {

ceres::Solver::Options Options() {
  ceres::Solver::Options options;
  options.linear_solver_type = ceres::DENSE_QR;
  options.function_tolerance = 0;
  options.gradient_tolerance = 1e-14;
  options.logging_type = ceres::SILENT;
  return options;
}

// (x - 1, y - 2), unless x is above 10.
bool Distance(const Eigen::VectorXd& x, Eigen::VectorXd* residual,
              Eigen::MatrixXd* jacobian) {
  *residual = x - Eigen::Vector2d(1, 2);
  if (jacobian != nullptr) {
    *jacobian = Eigen::Matrix2d::Identity();
  }
  return x(0) <= 10;
}

TEST(MinimizeOverVariables, KeepsBounds) {
  const BoundedMinimum minimum =
      MinimizeOverVariables(Distance, 2, {Bounds{}, Bounds{{}, 1.5}},
                            Eigen::Vector2d(0, 0), Options());
  EXPECT_EQ(minimum.end, End::kDone);
  EXPECT_NEAR(minimum.variables(0), 1, 1e-6);
  EXPECT_NEAR(minimum.variables(1), 1.5, 1e-9);
  EXPECT_EQ(minimum.on_bound[0], Side::kNone);
  EXPECT_EQ(minimum.on_bound[1], Side::kUpper);
  EXPECT_NEAR(minimum.cost, 0.125, 1e-9);
}

TEST(MinimizeOverVariables, TakesTheStepThatEndsTheSearch) {
  // All that can be gained is less than the tolerance of the cost.
  const auto with_floor = [](const Eigen::VectorXd& x,
                             Eigen::VectorXd* residual,
                             Eigen::MatrixXd* jacobian) {
    *residual = Eigen::Vector3d(x(0) - 1, x(1) - 2, 10);
    if (jacobian != nullptr) {
      *jacobian = Eigen::Matrix<double, 3, 2>::Identity();
    }
    return true;
  };
  ceres::Solver::Options options = Options();
  options.function_tolerance = 1e-3;
  for (const double upper : {5.0, 1.95}) {
    const BoundedMinimum minimum =
        MinimizeOverVariables(with_floor, 3, {Bounds{}, Bounds{{}, upper}},
                              Eigen::Vector2d(0.9, 1.94), options);
    const double y = std::min(2.0, upper);
    EXPECT_EQ(minimum.end, End::kDone);
    EXPECT_NEAR(minimum.variables(0), 1, 1e-4);
    EXPECT_NEAR(minimum.variables(1), y, 1e-4);
    EXPECT_NEAR(minimum.cost, 50 + (2 - y) * (2 - y) / 2, 1e-6);
  }
}

// (x + 1, l x^2 + x - 1) has its minimum at 0 [Dennis & Schnabel, Numerical
// Methods for Unconstrained Optimization].  There a Gauss-Newton step changes
// x to l x, so that it would take 300 of them.
TEST(MinimizeOverVariables, ConvergesQuicklyWhereLargeResidualsAreLeft) {
  constexpr double kFactor = -0.95;
  int num_jacobians = 0;
  const auto residual_of = [&](const Eigen::VectorXd& x,
                               Eigen::VectorXd* residual,
                               Eigen::MatrixXd* jacobian) {
    *residual = Eigen::Vector2d(x(0) + 1, kFactor * x(0) * x(0) + x(0) - 1);
    if (jacobian != nullptr) {
      ++num_jacobians;
      *jacobian = Eigen::Vector2d(1, 2 * kFactor * x(0) + 1);
    }
    return true;
  };
  const BoundedMinimum minimum = MinimizeOverVariables(
      residual_of, 2, {Bounds{}}, Eigen::VectorXd::Constant(1, 0.1), Options());
  EXPECT_EQ(minimum.end, End::kDone);
  EXPECT_NEAR(minimum.variables(0), 0, 1e-7);
  EXPECT_LE(num_jacobians, 12);
}

TEST(MinimizeOverVariables, HasNoCostWithoutAValueAtTheStart) {
  const BoundedMinimum minimum = MinimizeOverVariables(
      Distance, 2, {Bounds{}, Bounds{}}, Eigen::Vector2d(20, 0), Options());
  EXPECT_EQ(minimum.end, End::kSearchFailed);
  EXPECT_TRUE(std::isinf(minimum.cost));
}

}  // namespace
}  // namespace elastimate
