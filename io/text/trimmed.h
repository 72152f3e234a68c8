#ifndef ELASTIMATE_IO_TEXT_TRIMMED_H_
#define ELASTIMATE_IO_TEXT_TRIMMED_H_

#include <string_view>

namespace elastimate {

/// Returns the text without the blanks, tabulators and returns at its ends.
inline std::string_view Trimmed(std::string_view text) {
  constexpr char kBlanks[] = " \t\r";
  const std::size_t first = text.find_first_not_of(kBlanks);
  return first == std::string_view::npos
             ? std::string_view()
             : text.substr(first, text.find_last_not_of(kBlanks) - first + 1);
}

}  // namespace elastimate

#endif  // ELASTIMATE_IO_TEXT_TRIMMED_H_
