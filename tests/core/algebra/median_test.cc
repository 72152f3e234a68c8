#include "elastimate/core/algebra/median.h"

#include <gtest/gtest.h>

namespace elastimate {
namespace {

TEST(Median, OfOddAndEvenNumbersOfValues) {
  EXPECT_EQ(Median({3}), 3);
  EXPECT_EQ(Median({5, 1, 3}), 3);
  EXPECT_EQ(Median({4, 1, 3, 2}), 2.5);
  EXPECT_EQ(Median({1e9, -1e9, 0, 1}), 0.5);
}

}  // namespace
}  // namespace elastimate
