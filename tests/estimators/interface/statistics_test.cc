#include "elastimate/estimators/interface/statistics.h"

#include <gtest/gtest.h>

#include <limits>
#include <string>

namespace elastimate {
namespace {

TEST(LeastAbsoluteDeviations, IsNotMovedByOutliers) {
  const Eigen::VectorXd x = Eigen::VectorXd::LinSpaced(50, -3, 4);
  Eigen::VectorXd y = 2.5 * x;
  for (Eigen::Index i = 0; i < y.size(); i += 3) {
    y(i) -= 1e6 * x(i);
  }
  EXPECT_NEAR(LeastAbsoluteDeviations(x, y), 2.5, 1e-12);
}

TEST(LeastAbsoluteDeviations, MinimisesTheSumOfAbsoluteDeviations) {
  const Eigen::VectorXd x = Eigen::VectorXd::Random(21);
  const Eigen::VectorXd y = Eigen::VectorXd::Random(21);
  const double t = LeastAbsoluteDeviations(x, y);
  const double least = (y - t * x).lpNorm<1>();
  for (const double other : {t - 1, t - 1e-3, t + 1e-3, t + 1}) {
    EXPECT_GT((y - other * x).lpNorm<1>(), least);
  }
}

// The numbers are those of a table [Abramowitz & Stegun 1964, table 26.10].
TEST(StudentsT, HasItsQuantiles) {
  EXPECT_NEAR(TwoSidedErrors(1), 12.706, 5e-4);
  EXPECT_NEAR(TwoSidedErrors(10), 2.228, 5e-4);
  EXPECT_NEAR(OneSidedErrors(10), 1.812, 5e-4);
  EXPECT_NEAR(TwoSidedErrors(1e9), TwoSidedErrors({}), 5e-4);
  EXPECT_NEAR(OneSidedErrors(1e9), OneSidedErrors({}), 5e-4);
}

}  // namespace
}  // namespace elastimate
