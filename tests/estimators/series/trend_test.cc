#include "elastimate/estimators/series/trend.h"

#include <gtest/gtest.h>

#include <cmath>

namespace elastimate {
namespace {

// Residuals of +- 1 that are no slope: sum of squares 6, 4 degrees of freedom.
Eigen::VectorXd Zigzag() {
  Eigen::VectorXd values(6);
  values << 1, -1, -1, 1, 1, -1;
  const Eigen::VectorXd x = Eigen::VectorXd::LinSpaced(6, -2.5, 2.5);
  return values - x * (x.dot(values) / x.squaredNorm());
}

TEST(FindTrend, FollowsTheLine) {
  const Eigen::VectorXd x = Eigen::VectorXd::LinSpaced(6, 10, 15);
  const Eigen::VectorXd values = 3 + 0.2 * x.array();
  const std::optional<Trend> trend =
      FindTrend(x, values, Eigen::VectorXd::Constant(6, 0.04));
  ASSERT_TRUE(trend.has_value());
  EXPECT_NEAR(trend->change(0), 1, 1e-12);
  // sum of (x - 12.5)^2 = 17.5.
  EXPECT_NEAR(trend->standard_error(0), 5 * 0.2 / std::sqrt(17.5), 1e-12);
}

TEST(FindTrend, TakesTheScatterWhereItIsLarger) {
  const Eigen::VectorXd x = Eigen::VectorXd::LinSpaced(6, -2.5, 2.5);
  const Eigen::VectorXd scatter = Zigzag();
  const double variance = scatter.squaredNorm() / 4;
  // 2.776 is the quantile of Student's t of 4 degrees of freedom at 97.5 %.
  const double slope = 2.776445 * std::sqrt(variance / 17.5);
  const std::optional<Trend> trend =
      FindTrend(x, scatter + slope * x, Eigen::VectorXd::Constant(6, 1e-6));
  ASSERT_TRUE(trend.has_value());
  EXPECT_NEAR(trend->change(0), 5 * slope, 1e-9);
  EXPECT_NEAR(trend->standard_error(0), 5 * std::sqrt(variance / 17.5), 1e-9);
  EXPECT_NEAR(trend->p_value(0), 0.05, 1e-6);
}

TEST(FindTrend, WeighsByVariances) {
  const Eigen::Vector4d x(0, 1, 2, 10);
  const Eigen::Vector4d values(1, 2, 3, -100);
  const std::optional<Trend> trend =
      FindTrend(x, values, Eigen::Vector4d(1, 1, 1, 1e12));
  ASSERT_TRUE(trend.has_value());
  EXPECT_NEAR(trend->change(0), 10, 1e-6);
}

TEST(FindTrend, NeedsFourValuesThatDiffer) {
  const Eigen::Vector3d three(1, 2, 3);
  EXPECT_FALSE(FindTrend(three, three, three).has_value());
  const Eigen::VectorXd same = Eigen::VectorXd::Ones(6);
  EXPECT_FALSE(FindTrend(same, Zigzag(), same).has_value());
}

}  // namespace
}  // namespace elastimate
