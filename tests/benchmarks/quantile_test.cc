#include "benchmarks/quantile.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

namespace elastimate {
namespace {

constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();
constexpr double kInfinity = std::numeric_limits<double>::infinity();

TEST(Quantile, LiesBetweenTheValues) {
  EXPECT_EQ(Quantile({3, 1, 2}, 0.5), 2);
  EXPECT_EQ(Quantile({4, 1, 2, 3}, 0.5), 2.5);
  EXPECT_EQ(Quantile({0, 10}, 0.25), 2.5);
  EXPECT_EQ(Quantile({5, 4}, 0), 4);
  EXPECT_EQ(Quantile({5, 4}, 1), 5);
}

TEST(Quantile, LeavesOutWhatIsNoNumber) {
  EXPECT_EQ(Quantile({kNaN, 1, kNaN, 3}, 0.5), 2);
  EXPECT_TRUE(std::isnan(Quantile({kNaN}, 0.5)));
  EXPECT_EQ(Quantile({kInfinity, kInfinity}, 0.5), kInfinity);
}

TEST(MedianMagnitude, IsOfAbsoluteValues) {
  EXPECT_EQ(MedianMagnitude({-3, 1, 2}), 2);
}

}  // namespace
}  // namespace elastimate
