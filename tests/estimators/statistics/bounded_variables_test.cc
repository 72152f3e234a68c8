#include "elastimate/estimators/statistics/bounded_variables.h"

#include <gtest/gtest.h>

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

TEST(MinimizeOverVariables, HasNoCostWithoutAValueAtTheStart) {
  const BoundedMinimum minimum = MinimizeOverVariables(
      Distance, 2, {Bounds{}, Bounds{}}, Eigen::Vector2d(20, 0), Options());
  EXPECT_EQ(minimum.end, End::kSearchFailed);
  EXPECT_TRUE(std::isinf(minimum.cost));
}

}  // namespace
}  // namespace elastimate
