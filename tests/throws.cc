#include "tests/throws.h"

#include <gmock/gmock.h>

#include <stdexcept>

namespace elastimate::testing {

::testing::AssertionResult ThrowsWith(const std::function<void()>& statement,
                                      const std::string& pattern) {
  ::testing::StringMatchResultListener listener;
  const bool throws = ::testing::ExplainMatchResult(
      ::testing::ThrowsMessage<std::invalid_argument>(
          ::testing::ContainsRegex(pattern)),
      statement, &listener);
  return (throws ? ::testing::AssertionSuccess()
                 : ::testing::AssertionFailure())
         << "for '" << pattern << "': it " << listener.str();
}

}  // namespace elastimate::testing
