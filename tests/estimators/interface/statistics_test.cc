#include "elastimate/estimators/interface/statistics.h"

#include <gtest/gtest.h>

#include <limits>
#include <string>

namespace elastimate {
namespace {

TEST(Median, OfOddAndEvenNumbersOfValues) {
  EXPECT_EQ(Median({3}), 3);
  EXPECT_EQ(Median({5, 1, 3}), 3);
  EXPECT_EQ(Median({4, 1, 3, 2}), 2.5);
  EXPECT_EQ(Median({1e9, -1e9, 0, 1}), 0.5);
}

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

TEST(TwoDigits, AreForSentences) {
  EXPECT_EQ(TwoDigits(0), "0");
  EXPECT_EQ(TwoDigits(0.01234), "0.012");
  EXPECT_EQ(TwoDigits(-0.07), "-0.07");
  EXPECT_EQ(TwoDigits(0.9951), "1");
  EXPECT_EQ(TwoDigits(3), "3");
  EXPECT_EQ(TwoDigits(99.9), "100");
  EXPECT_EQ(TwoDigits(1234), "1200");
  EXPECT_EQ(TwoDigits(1.26e7), "1.3e+07");
  EXPECT_EQ(TwoDigits(std::numeric_limits<double>::infinity()), "inf");
}

Estimate WithCovariance(double youngs_sd, double nu_sd, double correlation) {
  Estimate estimate;
  estimate.elasticity = {100, 0.25};
  const double covariance = correlation * youngs_sd * nu_sd;
  estimate.covariance << youngs_sd * youngs_sd, covariance, covariance,
      nu_sd * nu_sd;
  return estimate;
}

TEST(DescribeWhatIsDetermined, YoungsModulus) {
  const std::string text = DescribeWhatIsDetermined(WithCovariance(1, 0.2, 0));
  EXPECT_NE(text.find("Young's modulus = 100 +- 1"), std::string::npos) << text;
}

TEST(DescribeWhatIsDetermined, TheShearModulus) {
  // mu = E / (2 (1 + nu)) keeps its value when dE / E = dnu / (1 + nu).
  const std::string text =
      DescribeWhatIsDetermined(WithCovariance(0.2 / 1.25 * 100, 0.2, 0.999999));
  EXPECT_NE(text.find("the shear modulus = 40 +- "), std::string::npos) << text;
}

TEST(DescribeWhatIsDetermined, Nothing) {
  const std::string text = DescribeWhatIsDetermined(WithCovariance(50, 0.5, 0));
  EXPECT_NE(text.find("nor do they determine E"), std::string::npos) << text;
}

TEST(DescribeCollinear, NamesTheModulusThatStays) {
  const IsotropicElasticity elasticity{100, 0.25};
  EXPECT_NE(DescribeCollinear(elasticity, {0, 1}).find("Young's modulus = 100"),
            std::string::npos);
  EXPECT_NE(DescribeCollinear(elasticity, {1 / 1.25, 1})
                .find("the shear modulus = 40"),
            std::string::npos);
  EXPECT_NE(DescribeCollinear(elasticity, {-2 / 0.5, 1})
                .find("the bulk modulus = 66.6667"),
            std::string::npos);
  EXPECT_EQ(DescribeCollinear(elasticity, {1, 0}).find(" = "),
            std::string::npos);
}

}  // namespace
}  // namespace elastimate
