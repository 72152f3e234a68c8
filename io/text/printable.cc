#include "elastimate/io/text/printable.h"

#include <cstdint>
#include <cstdio>
#include <vector>

namespace elastimate {
namespace {

/// A character, or a byte that begins none.
struct Character {
  std::uint32_t code;
  std::size_t size;  ///< In bytes.
  bool is_valid;
};

/// Returns the first character of `text`, which is not empty, by table 3-7 of
/// the Unicode standard.
Character Decode(std::string_view text) {
  const auto byte = [&text](std::size_t i) -> std::uint32_t {
    return i < text.size() ? static_cast<unsigned char>(text[i]) : 0;
  };
  const std::uint32_t first = byte(0);
  if (first < 0x80) {
    return {first, 1, true};
  }
  const std::size_t size = first >= 0xF0 ? 4 : first >= 0xE0 ? 3 : 2;
  std::uint32_t code = first & (0x7FU >> size);
  bool is_valid = first >= 0xC2 && first <= 0xF4;
  for (std::size_t i = 1; i < size; ++i) {
    is_valid = is_valid && (byte(i) & 0xC0U) == 0x80;
    code = code << 6U | (byte(i) & 0x3FU);
  }
  constexpr std::uint32_t kSmallest[5] = {0, 0, 0x80, 0x800, 0x10000};
  const bool is_surrogate = code >= 0xD800 && code <= 0xDFFF;
  if (!is_valid || code < kSmallest[size] || code > 0x10FFFF || is_surrogate) {
    return {first, 1, false};
  }
  return {code, size, true};
}

/// These are control characters, line separators, and what changes the
/// direction of writing, so that a name could look like another one.
bool SpeaksToTheTerminal(std::uint32_t code) {
  return code < 0x20 || (code >= 0x7F && code < 0xA0) || code == 0x61C ||
         code == 0x200B || code == 0x200E || code == 0x200F ||
         (code >= 0x2028 && code <= 0x202E) ||
         (code >= 0x2060 && code <= 0x206F) || code == 0xFEFF;
}

std::string Escaped(const Character& character) {
  constexpr std::uint32_t kMicroOfLatin1 = 0xB5;
  if (!character.is_valid && character.code == kMicroOfLatin1) {
    return "\xC2\xB5";
  }
  switch (character.code) {
    case '\n':
      return "\\n";
    case '\t':
      return "\\t";
    case '\r':
      return "\\r";
    default:
      break;
  }
  char text[16] = {};
  const bool is_byte = !character.is_valid || character.code < 0x80;
  std::snprintf(text, sizeof text, is_byte ? "\\x%02x" : "\\u%04x",
                static_cast<unsigned>(character.code));
  return text;
}

}  // namespace

std::string Printable(std::string_view text, std::size_t longest) {
  std::vector<std::string> characters;
  while (!text.empty()) {
    const Character character = Decode(text);
    characters.push_back(!character.is_valid ||
                                 SpeaksToTheTerminal(character.code)
                             ? Escaped(character)
                             : std::string(text.substr(0, character.size)));
    text.remove_prefix(character.size);
  }
  const std::string dots = "...";
  const bool is_cut = characters.size() > longest;
  const std::size_t tail = is_cut ? longest / 3 : 0;
  const std::size_t head =
      is_cut ? longest - tail - dots.size() : characters.size();
  std::string printable;
  for (std::size_t i = 0; i < head; ++i) {
    printable += characters[i];
  }
  printable += is_cut ? dots : "";
  for (std::size_t i = characters.size() - tail; i < characters.size(); ++i) {
    printable += characters[i];
  }
  return printable;
}

}  // namespace elastimate
