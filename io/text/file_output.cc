#include "elastimate/io/text/file_output.h"

#include <fcntl.h>
#include <sys/random.h>
#include <sys/stat.h>
#include <unistd.h>

#include <atomic>
#include <cerrno>
#include <climits>
#include <cstdint>
#include <cstring>
#include <string_view>
#include <system_error>
#include <utility>

#include "elastimate/io/text/input_error.h"
#include "elastimate/io/text/printable.h"

namespace elastimate {

/// The name of a staged file, where a signal handler finds it.  Places for
/// names are reused, but never freed.
struct StagedName {
  enum class State { kFree, kTaken, kNamed };
  std::atomic<State> state = State::kTaken;
  char name[PATH_MAX] = {};
  StagedName* next = nullptr;
};

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
  /// Returns false, with errno set, when what was written did not arrive.
  bool Close() { return close(std::exchange(descriptor_, -1)) == 0; }

 private:
  int descriptor_;
};

/// Returns false, with errno set, when not all could be written.
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

/// Returns the file to which `path` leads, so that a symbolic link stays one.
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

/// Tells whether `path` names an open file by its number, as /dev/stdout and
/// /dev/fd/3 do, directly or through symbolic links.
bool IsDescriptor(fs::path path) {
  std::error_code error;
  for (int depth = 0; depth < 40; ++depth) {
    const fs::path folder = fs::weakly_canonical(Folder(path), error);
    if (folder.filename() == "fd" && folder.string().rfind("/proc/", 0) == 0) {
      return true;
    }
    if (!fs::is_symlink(path, error)) {
      break;
    }
    path = path.parent_path() / fs::read_symlink(path, error);
  }
  return false;
}

/// Tells whether `path` is a terminal or the like, or a pipe, which no new file
/// may replace.
bool IsWrittenInPlace(const fs::path& path) {
  std::error_code error;
  const fs::file_status status = fs::status(path, error);
  return fs::is_character_file(status) || fs::is_fifo(status);
}

/// Throws where `path` could be written in part only, or writing would destroy
/// more than a file.
void CheckKindOfFile(const fs::path& path) {
  std::error_code error;
  const fs::file_status status = fs::status(path, error);
  if (fs::is_directory(status)) {
    ThrowInputError(path, "this is a folder; give the name of a file to write");
  }
  if (fs::is_block_file(status) || fs::is_socket(status)) {
    ThrowInputError(path,
                    "this is a disk or a socket; give the name of a file "
                    "to write");
  }
  if (IsDescriptor(path) && !IsWrittenInPlace(path)) {
    ThrowInputError(path,
                    "this is the number of an open file, which could be "
                    "written in part; give the name of a file to write");
  }
}

void WriteInPlace(const fs::path& path, const std::string& content) {
  FileDescriptor file(open(path.c_str(), O_WRONLY | O_APPEND | O_CLOEXEC));
  if (file.Get() < 0 || !WriteAll(file.Get(), content) || !file.Close()) {
    ThrowErrno(path, errno);
  }
}

static_assert(std::atomic<StagedName::State>::is_always_lock_free &&
                  std::atomic<StagedName*>::is_always_lock_free,
              "a signal handler may not wait for a lock");

std::atomic<StagedName*> first_staged_name = nullptr;

bool Take(StagedName& place) {
  auto free = StagedName::State::kFree;
  return place.state.compare_exchange_strong(free, StagedName::State::kTaken);
}

/// Notes a name, which must have its end within PATH_MAX, until it is released.
StagedName* Note(const fs::path& name) {
  StagedName* place = first_staged_name;
  while (place != nullptr && !Take(*place)) {
    place = place->next;
  }
  if (place == nullptr) {
    place = new StagedName;
    place->next = first_staged_name;
    while (!first_staged_name.compare_exchange_weak(place->next, place)) {
    }
  }
  std::strncpy(place->name, name.c_str(), sizeof place->name - 1);
  place->state = StagedName::State::kNamed;
  return place;
}

void Release(StagedName* place) { place->state = StagedName::State::kFree; }

/// Returns a name beside `target` that no other process takes, not even one of
/// the same number in another container.
fs::path PartName(const fs::path& target) {
  std::uint64_t random = 0;
  if (getrandom(&random, sizeof random, 0) != sizeof random) {
    random = static_cast<std::uint64_t>(getpid());
  }
  return Folder(target) / ("." + target.filename().string() + "." +
                           std::to_string(random) + ".part");
}

/// Opens a new file beside `target`, whose name goes to `name` and is noted at
/// `place` when that succeeds.
int OpenNewFile(const fs::path& target, fs::path& name, StagedName*& place) {
  int descriptor = -1;
  for (int attempt = 0; attempt < 100; ++attempt) {
    name = PartName(target);
    if (name.native().size() >= PATH_MAX) {
      errno = ENAMETOOLONG;
      return -1;
    }
    // The name is noted before there is a file, so that no file is ever unknown
    // here.
    place = Note(name);
    // Unlike mkstemp's, its permissions follow the user's umask.
    descriptor =
        open(name.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, 0666);
    if (descriptor >= 0) {
      break;
    }
    const int reason = errno;
    Release(place);
    errno = reason;
    if (reason != EEXIST) {
      break;
    }
  }
  return descriptor;
}

}  // namespace

void UnlinkStagedFiles() {
  for (const StagedName* place = first_staged_name; place != nullptr;
       place = place->next) {
    if (place->state == StagedName::State::kNamed) {
      unlink(place->name);
    }
  }
}

StagedFiles::~StagedFiles() {
  for (const Part& part : parts_) {
    unlink(part.name.c_str());
    Release(part.place);
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
  StagedName* place = nullptr;
  FileDescriptor file(OpenNewFile(target, name, place));
  if (file.Get() < 0) {
    ThrowErrno(path, errno);
  }
  parts_.push_back({path, target, name, place});
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
    Release(part.place);
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
  CheckKindOfFile(path);
  std::error_code error;
  if (fs::exists(path, error) && access(path.c_str(), W_OK) != 0) {
    ThrowErrno(path, errno);
  }
  if (IsWrittenInPlace(path)) {
    return;
  }
  const fs::path folder = Folder(FollowLinks(path));
  if (!fs::is_directory(folder, error)) {
    ThrowInputError(path, "there is no folder '" + PrintablePath(folder) +
                              "' to write it in; make the folder first");
  }
  if (access(folder.c_str(), W_OK | X_OK) != 0) {
    ThrowErrno(path, errno);
  }
}

}  // namespace elastimate
