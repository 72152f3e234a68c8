#ifndef ELASTIMATE_IO_TEXT_FILE_LINES_H_
#define ELASTIMATE_IO_TEXT_FILE_LINES_H_

#include <cstddef>
#include <filesystem>
#include <vector>

namespace elastimate {

/// Where things that follow one another stand in a text file.
struct FileLines {
  std::filesystem::path file;
  std::vector<std::size_t> lines;  ///< From 1 on.
};

}  // namespace elastimate

#endif  // ELASTIMATE_IO_TEXT_FILE_LINES_H_
