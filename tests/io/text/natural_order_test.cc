#include "elastimate/io/text/natural_order.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <string>
#include <vector>

namespace elastimate {
namespace {

using Names = std::vector<std::string>;

// Whether the names, in any order, are sorted to this one.
void ExpectOrder(const Names& expected) {
  Names names = expected;
  std::sort(names.begin(), names.end());
  for (int i = 0; i < 2; ++i) {
    SortByNumbers(names);
    EXPECT_EQ(names, expected);
    std::reverse(names.begin(), names.end());
  }
}

TEST(NaturalOrderTest, GoesBySizeOfIntegers) {
  ExpectOrder({"frame1", "frame2", "frame10"});
  ExpectOrder({"frame_0009.csv", "frame_10.csv", "frame_00011.csv"});
  ExpectOrder({"a_2_step_10", "a_10_step_9", "a_10_step_10", "b_1_step_1"});
  // More digits than a double has.
  ExpectOrder({"20240101120000123456", "20240101120000123457"});
}

TEST(NaturalOrderTest, GoesBySizeOfDecimals) {
  ExpectOrder({"load_1.0kN", "load_1.25kN", "load_1.5kN", "load_1.75kN",
               "load_2.0kN", "load_10.0kN"});
  ExpectOrder({"u 0,05 mm.csv", "u 0,5 mm.csv", "u 1 mm.csv"});
  ExpectOrder({"1.05_9", "1.05_10", "1.5_1"});
  ExpectOrder({"0.csv", "0.001.csv", "0.01.csv", "1.csv"});
}

TEST(NaturalOrderTest, TellsCountersAndDatesFromDecimals) {
  ExpectOrder({"test1.8", "test1.9", "test1.10", "test2.1"});
  ExpectOrder({"v1.2.3", "v1.2.10", "v1.10.1"});
  ExpectOrder({"2024.01.31 1.5", "2024.02.01 1.25", "2024.10.01 1.25"});
}

TEST(NaturalOrderTest, TakesAHyphenForASignWhereItIsNoDash) {
  ExpectOrder({"u_-2.5mm", "u_-1mm", "u_0mm", "u_1mm"});
  ExpectOrder({"a-1.csv", "a-2.csv", "a-10.csv"});
  ExpectOrder({"2024-01-02", "2024-01-10", "2024-11-01"});
  ExpectOrder({"-2", "-1", "3"});
}

TEST(NaturalOrderTest, ReadsExponents) {
  ExpectOrder({"p_1e-3", "p_2e-3", "p_1e-2", "p_5"});
  ExpectOrder({"p=2.5E+02", "p=1e3"});
  // Behind a letter it is a name.
  ExpectOrder({"sample1e-1", "sample1e-2", "sample1e-10"});
}

TEST(NaturalOrderTest, TakesAnyBytes) {
  Names names = {"", "-", "1e", "1.", "1e999999999999", "\xFF", "--1", ".5"};
  SortByNumbers(names);
  EXPECT_THAT(names, ::testing::SizeIs(8));
}

}  // namespace
}  // namespace elastimate
