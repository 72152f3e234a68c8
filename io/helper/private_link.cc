#include "elastimate/io/helper/private_link.h"

#include <cstdlib>
#include <stdexcept>
#include <system_error>

namespace elastimate {

PrivateLink::PrivateLink(const std::filesystem::path& file,
                         const std::string& name) {
  std::error_code error;
  const std::filesystem::path temporary =
      std::filesystem::temp_directory_path(error);
  std::string folder = (temporary / "elastimate-XXXXXX").string();
  if (error || mkdtemp(folder.data()) == nullptr) {
    throw std::runtime_error(
        "no folder can be made in the folder for temporary files (" +
        (error ? "none" : temporary.string()) +
        "); name another one in the environment variable TMPDIR");
  }
  path_ = std::filesystem::path(folder) / name;
  std::filesystem::create_symlink(std::filesystem::absolute(file), path_,
                                  error);
  if (error) {
    std::filesystem::remove(folder, error);
    throw std::runtime_error("no link can be made in " + folder +
                             "; name another folder for temporary files in "
                             "the environment variable TMPDIR");
  }
}

PrivateLink::~PrivateLink() {
  std::error_code error;
  std::filesystem::remove(path_, error);
  std::filesystem::remove(path_.parent_path(), error);
}

}  // namespace elastimate
