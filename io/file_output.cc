#include "elastimate/io/file_output.h"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <string_view>
#include <system_error>
#include <utility>

#include "elastimate/io/input_error.h"

namespace elastimate {
namespace {

namespace fs = std::filesystem;

[[noreturn]] void ThrowErrno(const fs::path& path, int error) {
  ThrowInputError(path, "cannot be written (" + std::string(strerror(error)) +
                            "); choose another file or make room");
}

class FileDescriptor {
 public:
  explicit FileDescriptor(int descriptor) : descriptor_(descriptor) {}
  ~FileDescriptor() {
    if (descriptor_ >= 0) {
      close(descriptor_);
    }
  }
  FileDescriptor(const FileDescriptor&) = delete;
  FileDescriptor& operator=(const FileDescriptor&) = delete;

  int Get() const { return descriptor_; }
  /// False, with errno set, when what was written did not arrive.
  bool Close() { return close(std::exchange(descriptor_, -1)) == 0; }

 private:
  int descriptor_;
};

/// False, with errno set, when not all could be written.
bool WriteAll(int descriptor, std::string_view content) {
  while (!content.empty()) {
    const ssize_t written = write(descriptor, content.data(), content.size());
    if (written < 0 && errno != EINTR) {
      return false;
    }
    content.remove_prefix(written > 0 ? written : 0);
  }
  return true;
}

/// The file that `path` leads to, so that a symbolic link stays one.
fs::path FollowLinks(fs::path path) {
  std::error_code error;
  for (int depth = 0; depth < 40 && fs::is_symlink(path, error); ++depth) {
    const fs::path target = fs::read_symlink(path, error);
    if (error) {
      break;
    }
    path = path.parent_path() / target;
  }
  return path;
}

fs::path Folder(const fs::path& path) {
  return path.has_parent_path() ? path.parent_path() : fs::path(".");
}

/// Whether `path` is a device, a pipe or the like, or names an open file
/// (/dev/stdout), none of which a new file may replace.
bool IsWrittenInPlace(const fs::path& path) {
  std::error_code error;
  const fs::file_status status = fs::status(path, error);
  const std::string name = path.string();
  return fs::exists(status) &&
         (!fs::is_regular_file(status) || name.rfind("/dev/", 0) == 0 ||
          name.rfind("/proc/", 0) == 0);
}

void WriteInPlace(const fs::path& path, const std::string& content) {
  FileDescriptor file(open(path.c_str(), O_WRONLY | O_APPEND | O_CLOEXEC));
  if (file.Get() < 0 || !WriteAll(file.Get(), content) || !file.Close()) {
    ThrowErrno(path, errno);
  }
}

/// Opens a new file beside `target`, whose name goes to `name`.
int OpenNewFile(const fs::path& target, fs::path& name) {
  int descriptor = -1;
  for (int attempt = 0; attempt < 1000; ++attempt) {
    name = Folder(target) /
           ("." + target.filename().string() + "." + std::to_string(getpid()) +
            "-" + std::to_string(attempt) + ".part");
    // Unlike mkstemp's, its permissions follow the user's umask.
    descriptor =
        open(name.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, 0666);
    if (descriptor >= 0 || errno != EEXIST) {
      break;
    }
  }
  return descriptor;
}

}  // namespace

StagedFiles::~StagedFiles() {
  for (const Part& part : parts_) {
    unlink(part.name.c_str());
  }
}

void StagedFiles::Add(const fs::path& path, const std::string& content) {
  CheckWritable(path);
  if (IsWrittenInPlace(path)) {
    WriteInPlace(path, content);
    return;
  }
  const fs::path target = FollowLinks(path);
  fs::path name;
  FileDescriptor file(OpenNewFile(target, name));
  if (file.Get() < 0) {
    ThrowErrno(path, errno);
  }
  parts_.push_back({path, target, name});
  struct stat old = {};
  const bool written = (stat(target.c_str(), &old) != 0 ||
                        fchmod(file.Get(), old.st_mode & 07777) == 0) &&
                       WriteAll(file.Get(), content) &&
                       fsync(file.Get()) == 0 && file.Close();
  if (!written) {
    ThrowErrno(path, errno);
  }
}

void StagedFiles::Commit() {
  for (; !parts_.empty(); parts_.pop_back()) {
    const Part& part = parts_.back();
    if (rename(part.name.c_str(), part.target.c_str()) != 0) {
      ThrowErrno(part.path, errno);
    }
  }
}

void WriteWholeFile(const fs::path& path, const std::string& content) {
  StagedFiles files;
  files.Add(path, content);
  files.Commit();
}

bool AreSameFile(const fs::path& first, const fs::path& second) {
  std::error_code error;
  if (fs::equivalent(first, second, error)) {
    return true;
  }
  const auto place = [&error](const fs::path& path) {
    return fs::weakly_canonical(fs::absolute(FollowLinks(path), error), error);
  };
  const fs::path first_place = place(first);
  return !error && first_place == place(second);
}

void CheckWritable(const fs::path& path) {
  if (!path.has_filename()) {
    ThrowInputError(path, "this names no file to write; give a file name");
  }
  std::error_code error;
  if (fs::is_directory(path, error)) {
    ThrowInputError(path, "this is a folder; give the name of a file to write");
  }
  if (fs::exists(path, error) && access(path.c_str(), W_OK) != 0) {
    ThrowErrno(path, errno);
  }
  if (IsWrittenInPlace(path)) {
    return;
  }
  const fs::path folder = Folder(FollowLinks(path));
  if (!fs::is_directory(folder, error)) {
    ThrowInputError(path, "there is no folder '" + folder.string() +
                              "' to write it in; make the folder first");
  }
  if (access(folder.c_str(), W_OK | X_OK) != 0) {
    ThrowErrno(path, errno);
  }
}

}  // namespace elastimate
