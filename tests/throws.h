#ifndef ELASTIMATE_TESTS_THROWS_H_
#define ELASTIMATE_TESTS_THROWS_H_

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <stdexcept>

/// The statement throws std::invalid_argument with a sentence that contains a
/// match of the regular expression.  (A macro, because it takes a statement.)
#define EXPECT_THROWS_WITH(statement, pattern)                 \
  EXPECT_THAT([&] { statement; },                              \
              ::testing::ThrowsMessage<std::invalid_argument>( \
                  ::testing::ContainsRegex(pattern)))

#endif  // ELASTIMATE_TESTS_THROWS_H_
