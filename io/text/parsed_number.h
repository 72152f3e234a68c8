#ifndef ELASTIMATE_IO_TEXT_PARSED_NUMBER_H_
#define ELASTIMATE_IO_TEXT_PARSED_NUMBER_H_

#include <charconv>
#include <optional>
#include <string_view>
#include <system_error>

namespace elastimate {

/// Returns the number that is all of a text, with or without a plus sign; empty
/// where the text is something else.
template <class Number>
std::optional<Number> ParsedNumber(std::string_view text) {
  Number number = 0;
  const char* const end = text.data() + text.size();
  const char* const begin =
      text.data() + (!text.empty() && text[0] == '+' ? 1 : 0);
  const auto [stop, error] = std::from_chars(begin, end, number);
  return error == std::errc() && stop == end ? std::optional<Number>(number)
                                             : std::nullopt;
}

}  // namespace elastimate

#endif  // ELASTIMATE_IO_TEXT_PARSED_NUMBER_H_
