#include "elastimate/estimators/statistics/error_propagation.h"

#include <gtest/gtest.h>

#include <cmath>

namespace elastimate {
namespace {

Estimate WithErrors() {
  Estimate estimate;
  estimate.elasticity = {5000, 0.3};
  // Of ln E 0.02, of nu 0.01, independent.
  estimate.covariance << 100 * 100, 0, 0, 0.01 * 0.01;
  estimate.error_budget.noise = Eigen::Vector2d(0.02, 0.01);
  estimate.discretization_error = 0.03;
  estimate.poisson_ratio_discretization_error = 0.04;
  return estimate;
}

TEST(PropagateErrors, IsThatOfALinearMap) {
  Estimate estimate = WithErrors();
  Eigen::Matrix2d propagation;
  propagation << 1, 3, 0, 5;
  PropagateErrors(propagation, estimate);
  EXPECT_NEAR(estimate.covariance(0, 0) / (5000. * 5000),
              0.02 * 0.02 + 0.03 * 0.03, 1e-15);
  EXPECT_NEAR(estimate.covariance(0, 1) / 5000, 0.03 * 0.05, 1e-15);
  EXPECT_NEAR(estimate.covariance(1, 0), estimate.covariance(0, 1), 1e-12);
  EXPECT_NEAR(estimate.covariance(1, 1), 0.05 * 0.05, 1e-15);
  EXPECT_NEAR(estimate.error_budget.noise(0), std::hypot(0.02, 0.03), 1e-15);
  EXPECT_NEAR(estimate.error_budget.noise(1), 0.05, 1e-15);
  EXPECT_NEAR(*estimate.discretization_error, std::hypot(0.03, 0.12), 1e-15);
  EXPECT_NEAR(*estimate.poisson_ratio_discretization_error, 0.2, 1e-15);
}

TEST(PropagateErrors, LeavesWhatIsNotKnownWithItsParameter) {
  Estimate estimate = WithErrors();
  estimate.covariance.col(1).setConstant(Estimate::kUnknown);
  estimate.covariance.row(1).setConstant(Estimate::kUnknown);
  estimate.error_budget.noise(1) = Estimate::kUnknown;
  estimate.poisson_ratio_discretization_error.reset();
  PropagateErrors(Eigen::Vector2d(2, 3).asDiagonal(), estimate);
  EXPECT_NEAR(std::sqrt(estimate.covariance(0, 0)), 200, 1e-10);
  EXPECT_TRUE(std::isnan(estimate.covariance(1, 1)));
  EXPECT_NEAR(estimate.error_budget.noise(0), 0.04, 1e-15);
  EXPECT_TRUE(std::isnan(estimate.error_budget.noise(1)));
  EXPECT_EQ(estimate.error_budget.model.size(), 0);
  EXPECT_NEAR(*estimate.discretization_error, 0.06, 1e-15);
  EXPECT_FALSE(estimate.poisson_ratio_discretization_error);
}

}  // namespace
}  // namespace elastimate
