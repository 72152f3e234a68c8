#include "elastimate/core/package/dynamic_module.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace elastimate {
namespace {

TEST(Module, HasTheFunctionThatIsLookedFor) {
  std::string why = "before";
  auto* const cosine = reinterpret_cast<double (*)(double)>(
      FindInModule("libm.so.6", "cos", why));
  ASSERT_NE(cosine, nullptr) << why;
  EXPECT_EQ(cosine(0), 1);
  EXPECT_EQ(why, "");
}

TEST(Module, SaysWhyItIsNotFound) {
  std::string why;
  EXPECT_EQ(FindInModule("libnone_of_this_name.so", "f", why), nullptr);
  EXPECT_THAT(why, ::testing::HasSubstr("libnone_of_this_name.so"));
}

TEST(Module, SaysWhyItsFunctionIsNotFound) {
  std::string why;
  EXPECT_EQ(FindInModule("libm.so.6", "none_of_this_name", why), nullptr);
  EXPECT_THAT(why, ::testing::HasSubstr("none_of_this_name"));
}

}  // namespace
}  // namespace elastimate
