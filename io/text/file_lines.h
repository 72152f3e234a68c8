#ifndef ELASTIMATE_IO_TEXT_FILE_LINES_H_
#define ELASTIMATE_IO_TEXT_FILE_LINES_H_

#include <cstddef>
#include <filesystem>
#include <vector>

namespace elastimate {

/// The lines of a text file in which things stand that follow one another.
struct FileLines {
  std::filesystem::path file;
  std::vector<std::size_t> lines;  ///< From 1 on.
};

}  // namespace elastimate

#endif  // ELASTIMATE_IO_TEXT_FILE_LINES_H_
