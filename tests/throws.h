#ifndef ELASTIMATE_TESTS_THROWS_H_
#define ELASTIMATE_TESTS_THROWS_H_

#include <gtest/gtest.h>

#include <functional>
#include <string>

namespace elastimate::testing {

::testing::AssertionResult ThrowsWith(const std::function<void()>& statement,
                                      const std::string& pattern);

}  // namespace elastimate::testing

/// The statement throws std::invalid_argument with a sentence that contains a
/// match of the regular expression.  (A macro, because it takes a statement.)
#define EXPECT_THROWS_WITH(statement, pattern) \
  EXPECT_TRUE(::elastimate::testing::ThrowsWith([&] { statement; }, pattern))

#endif  // ELASTIMATE_TESTS_THROWS_H_
