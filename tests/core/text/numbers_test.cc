#include "elastimate/core/text/numbers.h"

#include <gtest/gtest.h>

#include <limits>

namespace elastimate {
namespace {

TEST(NumbersInSentences, HaveSignificantDigits) {
  EXPECT_EQ(NumberText(2e-9), "2e-09");
  EXPECT_EQ(NumberText(0.123456789, 3), "0.123");
  EXPECT_EQ(NumberText(-std::numeric_limits<double>::quiet_NaN()), "nan");
  EXPECT_EQ(TwoDigits(104), "100");
  EXPECT_EQ(TwoDigits(-0.0123), "-0.012");
  EXPECT_EQ(TwoDigits(0), "0");
}

TEST(NumbersInSentences, HaveNoPercentageBeyondAThousand) {
  EXPECT_EQ(Percent(0.0123), "1.2 %");
  EXPECT_EQ(Percent(-9.9), "-990 %");
  EXPECT_EQ(Percent(10), "1000 %");
  EXPECT_EQ(PercentOf(0.5, "the load"), "50 % of the load");
  for (const double large :
       {10.1, -82.0, 4.3e12, std::numeric_limits<double>::infinity()}) {
    EXPECT_EQ(Percent(large), "more than ten times its value");
    EXPECT_EQ(PercentOf(large, "the load"), "more than ten times the load");
  }
}

}  // namespace
}  // namespace elastimate
