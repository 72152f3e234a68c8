#ifndef ELASTIMATE_IO_TEXT_TEXT_FILE_H_
#define ELASTIMATE_IO_TEXT_TEXT_FILE_H_

#include <filesystem>
#include <string>

namespace elastimate {

/// Returns the content of a text file without its byte order mark.  UTF-16,
/// which has the mark or a zero byte beside the first character, becomes UTF-8;
/// other text stays as it is.  Throws std::invalid_argument, naming the file,
/// where it cannot be read, is empty, or is no valid UTF-16.
std::string ReadTextFile(const std::filesystem::path& path);

}  // namespace elastimate

#endif  // ELASTIMATE_IO_TEXT_TEXT_FILE_H_
