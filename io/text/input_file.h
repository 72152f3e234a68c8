#ifndef ELASTIMATE_IO_TEXT_INPUT_FILE_H_
#define ELASTIMATE_IO_TEXT_INPUT_FILE_H_

#include <filesystem>

namespace elastimate {

/// Throws std::invalid_argument unless `path` is a regular file with content.
void CheckReadable(const std::filesystem::path& path);

}  // namespace elastimate

#endif  // ELASTIMATE_IO_TEXT_INPUT_FILE_H_
