#include "elastimate/core/text/numbers.h"

#include <gtest/gtest.h>

#include <limits>

namespace elastimate {
namespace {

TEST(NumbersInSentences, HaveSignificantDigits) {
  EXPECT_EQ(NumberText(2e-9), "2e-09");
  EXPECT_EQ(NumberText(0.123456789, 3), "0.123");
  EXPECT_EQ(NumberText(-std::numeric_limits<double>::quiet_NaN()), "nan");
  EXPECT_EQ(NumberText(13234, 3), "13200");
  EXPECT_EQ(NumberText(-999.6, 3), "-1000");
  EXPECT_EQ(NumberText(1234567), "1234570");
  EXPECT_EQ(NumberText(1.25e7, 2), "1.2e+07");
  EXPECT_EQ(TwoDigits(104), "100");
  EXPECT_EQ(TwoDigits(-0.0123), "-0.012");
  EXPECT_EQ(TwoDigits(0), "0");
}

TEST(NumbersInSentences, CountThings) {
  EXPECT_EQ(Counted(0, "node"), "0 nodes");
  EXPECT_EQ(Counted(1, "node"), "1 node");
  EXPECT_EQ(Counted(2, "node"), "2 nodes");
}

TEST(NumbersInTables, HaveTwoDigitsOfTheErrorAndNoExponent) {
  EXPECT_EQ(ValueWithError(2000, 400), "2000 +- 400");
  EXPECT_EQ(ValueWithError(49893.2, 117), "49890 +- 120");
  EXPECT_EQ(ValueWithError(0.34812, 0.01234), "0.348 +- 0.012");
  EXPECT_EQ(ValueWithError(0.299964, 2.0e-4), "0.29996 +- 0.00020");
  EXPECT_EQ(ValueWithError(-0.31, 0.2), "-0.31 +- 0.20");
  EXPECT_EQ(ValueWithError(9999999, 400000), "10000000 +- 400000");
  EXPECT_EQ(ValueWithError(3e-5, 0.02), "0.000 +- 0.020");
  EXPECT_EQ(ValueWithError(-1e-3, 0.2), "0.00 +- 0.20");
  EXPECT_EQ(ValueWithError(2e-4, 5e-5), "0.000200 +- 0.000050");
}

TEST(NumbersInTables, CarryWhatRoundingOfTheErrorMakesLonger) {
  EXPECT_EQ(ValueWithError(2000, 9.96), "2000 +- 10");
  EXPECT_EQ(ValueWithError(1, 0.0996), "1.00 +- 0.10");
  EXPECT_EQ(ValueWithError(1234, 99.6), "1230 +- 100");
  EXPECT_EQ(ValueWithError(1, 0.0994), "1.000 +- 0.099");
}

TEST(NumbersInTables, HaveAnExponentWhereTheyAreVeryLargeOrSmall) {
  EXPECT_EQ(ValueWithError(1.23456e9, 1.2e7), "1.2346e+09 +- 1.2e+07");
  EXPECT_EQ(ValueWithError(3e-5, 1e-5), "3e-05 +- 1e-05");
  EXPECT_EQ(ValueWithError(2000, 4e8), "2000 +- 4e+08");
}

TEST(NumbersInTables, HaveTenDigitsAtMost) {
  EXPECT_EQ(ValueWithError(0.3, 2e-13), "0.3000000000 +- 2e-13");
  EXPECT_EQ(ValueWithError(0.3, 0), "0.3 +- 0");
  EXPECT_EQ(ValueWithError(0.3, std::numeric_limits<double>::infinity()),
            "0.3 +- inf");
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
