#include "tests/io/mutations.h"

#include <algorithm>
#include <cctype>
#include <cstddef>
#include <utility>

namespace elastimate {
namespace {

using Place = std::pair<std::size_t, std::size_t>;  ///< Begin and size.

std::size_t Below(std::size_t limit, std::mt19937& random) {
  return limit == 0 ? 0 : random() % limit;
}

/// A line with its end.
Place SomeLine(const std::string& content, std::mt19937& random) {
  const std::size_t inside = Below(content.size(), random);
  const std::size_t before =
      inside == 0 ? std::string::npos : content.rfind('\n', inside - 1);
  const std::size_t begin = before == std::string::npos ? 0 : before + 1;
  const std::size_t end = content.find('\n', begin);
  return {begin, (end == std::string::npos ? content.size() : end + 1) - begin};
}

void Cut(std::string& content, std::mt19937& random) {
  content.resize(Below(content.size(), random));
}

void FlipBits(std::string& content, std::mt19937& random) {
  for (std::size_t i = 0; i <= Below(4, random); ++i) {
    char& byte = content[Below(content.size(), random)];
    byte = static_cast<char>(byte ^ (1 << Below(8, random)));
  }
}

void ReplaceBytes(std::string& content, std::mt19937& random) {
  for (std::size_t i = 0; i <= Below(4, random); ++i) {
    content[Below(content.size(), random)] =
        static_cast<char>(Below(256, random));
  }
}

void LoseBytes(std::string& content, std::mt19937& random) {
  content.erase(Below(content.size(), random), 1 + Below(100, random));
}

void ReplaceNumber(std::string& content, std::mt19937& random) {
  static const char* const kNumbers[] = {"-1",
                                         "0",
                                         "1",
                                         "7",
                                         "-7",
                                         "1000000000",
                                         "2147483647",
                                         "2147483648",
                                         "nan",
                                         "inf",
                                         "-inf",
                                         "4294967296",
                                         "1e400",
                                         "1e-400",
                                         "0x7f",
                                         "",
                                         "-",
                                         "x",
                                         "1e9",
                                         "100000",
                                         "-1e30",
                                         "3.14",
                                         "99999999999999999999"};
  const std::size_t begin =
      content.find_first_of("0123456789", Below(content.size(), random));
  if (begin == std::string::npos) {
    return;
  }
  const std::size_t end = content.find_first_not_of("0123456789.eE+-", begin);
  content.replace(begin, std::min(end, content.size()) - begin,
                  kNumbers[Below(std::size(kNumbers), random)]);
}

void DoubleLine(std::string& content, std::mt19937& random) {
  const auto [begin, size] = SomeLine(content, random);
  const std::string line = content.substr(begin, size);
  content.insert(begin, line);
}

void LoseLine(std::string& content, std::mt19937& random) {
  const auto [begin, size] = SomeLine(content, random);
  content.erase(begin, size);
}

/// Two lines, or all between a line and another.
void Swap(std::string& content, std::mt19937& random) {
  Place first = SomeLine(content, random);
  Place second = SomeLine(content, random);
  if (second < first) {
    std::swap(first, second);
  }
  if (Below(2, random) == 0) {
    std::rotate(content.begin() + first.first, content.begin() + second.first,
                content.begin() + second.first + second.second);
    return;
  }
  const std::string line = content.substr(second.first, second.second);
  content.replace(second.first, second.second,
                  content.substr(first.first, first.second));
  content.replace(first.first, first.second, line);
}

void ChangeLineEnds(std::string& content, std::mt19937& random) {
  const bool is_old_mac = Below(4, random) == 0;
  std::string changed;
  for (const char c : content) {
    changed += c != '\n' ? std::string(1, c) : is_old_mac ? "\r" : "\r\n";
  }
  content = changed;
}

void PutIn(std::string& content, std::mt19937& random) {
  static const std::string kTexts[] = {std::string(2000, 'a'),
                                       "\x1b[31m\a",
                                       std::string("\0\0", 2),
                                       "\xff\xfe",
                                       " 1 2 3\n",
                                       "\n\n",
                                       "\"",
                                       "<"};
  content.insert(Below(content.size(), random),
                 kTexts[Below(std::size(kTexts), random)]);
}

}  // namespace

std::string Mutated(std::string content, std::mt19937& random) {
  // Numbers more often: the kind that looks sound.
  static void (*const kMutations[])(std::string&, std::mt19937&) = {
      Cut,           FlipBits,      ReplaceBytes,  LoseBytes, ReplaceNumber,
      ReplaceNumber, DoubleLine,    LoseLine,      Swap,      Swap,
      PutIn,         ReplaceNumber, ChangeLineEnds};
  const std::size_t count = 1 + Below(3, random);
  for (std::size_t i = 0; i < count && !content.empty(); ++i) {
    kMutations[Below(std::size(kMutations), random)](content, random);
  }
  return content;
}

}  // namespace elastimate
