#ifndef ELASTIMATE_IO_HELPER_PRIVATE_LINK_H_
#define ELASTIMATE_IO_HELPER_PRIVATE_LINK_H_

#include <filesystem>
#include <string>

namespace elastimate {

/// A symbolic link to a file, in a folder of its own that nobody else writes
/// to: for programs that read other files beside the one they are given.
/// Removed with the object.
class PrivateLink {
 public:
  /// The link gets that name.  Throws std::runtime_error when the folder for
  /// temporary files takes none.
  PrivateLink(const std::filesystem::path& file, const std::string& name);
  ~PrivateLink();
  PrivateLink(const PrivateLink&) = delete;
  PrivateLink& operator=(const PrivateLink&) = delete;

  const std::filesystem::path& Path() const { return path_; }

 private:
  std::filesystem::path path_;
};

}  // namespace elastimate

#endif  // ELASTIMATE_IO_HELPER_PRIVATE_LINK_H_
