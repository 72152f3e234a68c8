#include "elastimate/io/text/text_file.h"

#include <iconv.h>

#include <cerrno>
#include <cstdint>
#include <fstream>
#include <iterator>
#include <string_view>
#include <system_error>

#include "elastimate/io/text/input_error.h"
#include "elastimate/io/text/input_file.h"

namespace elastimate {
namespace {

using namespace std::string_view_literals;

// `encoding` as iconv calls it.
std::string ToUtf8(const std::filesystem::path& path, std::string text,
                   const char* encoding) {
  iconv_t conversion = iconv_open("UTF-8", encoding);
  if (reinterpret_cast<std::intptr_t>(conversion) == -1) {
    throw std::system_error(errno, std::generic_category(), encoding);
  }
  // A character of two bytes becomes one of up to three.
  std::string converted(2 * text.size(), '\0');
  char* from = text.data();
  char* to = converted.data();
  std::size_t num_from = text.size();
  std::size_t num_to = converted.size();
  const bool is_converted = iconv(conversion, &from, &num_from, &to, &num_to) !=
                            static_cast<std::size_t>(-1);
  iconv_close(conversion);
  if (!is_converted) {
    ThrowInputError(path,
                    "the file begins as UTF-16, but has no character " +
                        std::to_string(num_from) +
                        " bytes before its end; write it again, as UTF-8");
  }
  converted.resize(converted.size() - num_to);
  return converted;
}

}  // namespace

std::string ReadTextFile(const std::filesystem::path& path) {
  CheckReadable(path);
  std::ifstream file(path, std::ios::binary);
  std::string text((std::istreambuf_iterator<char>(file)), {});
  if (file.bad()) {
    ThrowInputError(path, "the file cannot be read to its end");
  }
  const auto begins_with = [&text](std::string_view mark) {
    return std::string_view(text).substr(0, mark.size()) == mark;
  };
  if (begins_with("\xEF\xBB\xBF"sv)) {
    text.erase(0, 3);
  } else if (begins_with("\xFF\xFE"sv)) {
    text = ToUtf8(path, text.substr(2), "UTF-16LE");
  } else if (begins_with("\xFE\xFF"sv)) {
    text = ToUtf8(path, text.substr(2), "UTF-16BE");
  } else if (text.size() > 1 && (text[0] == '\0' || text[1] == '\0')) {
    text = ToUtf8(path, text, text[0] == '\0' ? "UTF-16BE" : "UTF-16LE");
  }
  return text;
}

}  // namespace elastimate
