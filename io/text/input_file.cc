#include "elastimate/io/text/input_file.h"

#include <fstream>
#include <system_error>

#include "elastimate/io/text/input_error.h"

namespace elastimate {

void CheckReadable(const std::filesystem::path& path) {
  std::error_code error;
  const std::filesystem::file_status status =
      std::filesystem::status(path, error);
  if (status.type() == std::filesystem::file_type::not_found) {
    ThrowInputError(path, "no such file; check the path");
  }
  if (std::filesystem::is_directory(status)) {
    ThrowInputError(path, "this is a folder; give a file");
  }
  if (!std::filesystem::is_regular_file(status)) {
    ThrowInputError(path, "this is not a regular file; give a file");
  }
  if (!std::ifstream(path, std::ios::binary)) {
    ThrowInputError(path, "the file cannot be opened; check its permissions");
  }
  if (std::filesystem::file_size(path, error) == 0) {
    ThrowInputError(path, "the file is empty; write it again");
  }
}

}  // namespace elastimate
