#ifndef ELASTIMATE_IO_FILE_OUTPUT_H_
#define ELASTIMATE_IO_FILE_OUTPUT_H_

#include <filesystem>
#include <string>

namespace elastimate {

/// Writes `content` to `path` so that the file appears whole or not at all: to
/// a new file in the same folder, which then takes the name.  Throws
/// std::invalid_argument, naming the file, when it cannot be written.
void WriteWholeFile(const std::filesystem::path& path,
                    const std::string& content);

/// Throws std::invalid_argument, naming the file, when `path` could not be
/// written: so that long work does not start in vain.  Creates nothing.
void CheckWritable(const std::filesystem::path& path);

}  // namespace elastimate

#endif  // ELASTIMATE_IO_FILE_OUTPUT_H_
