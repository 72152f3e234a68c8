#ifndef ELASTIMATE_IO_TEXT_PRINTABLE_H_
#define ELASTIMATE_IO_TEXT_PRINTABLE_H_

#include <cstddef>
#include <filesystem>
#include <string>
#include <string_view>

namespace elastimate {

/// The number of characters that a sentence quotes of a name, a cell or a flag,
/// and of a path, and the length of a whole sentence.
constexpr std::size_t kLongestQuote = 60;
constexpr std::size_t kLongestPath = 240;
constexpr std::size_t kLongestSentence = 1000;

/// Returns text from outside (a file, a file name, a flag) as messages quote
/// it: one line of valid UTF-8 that says nothing to a terminal.  Control
/// characters, marks that change the direction of writing, and bytes that are
/// no UTF-8 become \n, \t, \r, \x1b, \u202e, except that the micro sign of
/// Latin-1 becomes that of UTF-8.  Text of more than `longest`
/// characters has "..." in the place of its middle.  Idempotent;
/// O(text.size()).
std::string Printable(std::string_view text,
                      std::size_t longest = kLongestQuote);

/// Quotes a path in the same way.
inline std::string PrintablePath(const std::filesystem::path& path) {
  return Printable(path.string(), kLongestPath);
}

}  // namespace elastimate

#endif  // ELASTIMATE_IO_TEXT_PRINTABLE_H_
