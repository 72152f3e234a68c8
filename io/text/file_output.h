#ifndef ELASTIMATE_IO_TEXT_FILE_OUTPUT_H_
#define ELASTIMATE_IO_TEXT_FILE_OUTPUT_H_

#include <filesystem>
#include <string>
#include <vector>

namespace elastimate {

struct StagedName;

/// Files that appear together, each whole, or not at all.  Each is written to a
/// new file in its folder; the new files take the names when all are written.
class StagedFiles {
 public:
  StagedFiles() = default;
  /// Leaves no trace of what was not committed.
  ~StagedFiles();
  StagedFiles(const StagedFiles&) = delete;
  StagedFiles& operator=(const StagedFiles&) = delete;

  /// Writes `content` beside `path`, or at once if this is a terminal,
  /// /dev/null or a pipe; such outputs are best added last.  Throws
  /// std::invalid_argument, naming the file, when it cannot be written
  /// (CheckWritable).
  void Add(const std::filesystem::path& path, const std::string& content);

  /// Lets the files appear, in place of those that had their names.
  void Commit();

 private:
  struct Part {
    std::filesystem::path path;    ///< As the user calls it.
    std::filesystem::path target;  ///< What links lead to.
    std::filesystem::path name;    ///< Where it is written until then.
    StagedName* place;             ///< Where a signal handler finds `name`.
  };
  std::vector<Part> parts_;
};

/// Writes `content` to `path` so that the file appears whole or not at all: to
/// a new file in the same folder, which then takes the name.  Throws
/// std::invalid_argument, naming the file, when it cannot be written.
void WriteWholeFile(const std::filesystem::path& path,
                    const std::string& content);

/// Removes what StagedFiles of this process have written and not committed, for
/// the signal handler of a program that is about to end.  Async-signal-safe.  A
/// process that is killed (SIGKILL) leaves a file .NAME.NUMBER.part beside each
/// output.
void UnlinkStagedFiles();

/// Throws std::invalid_argument, naming the file, when `path` could not be
/// written, so that long work does not start in vain.  Creates nothing.  Disks
/// and sockets cannot be written, nor open files by their number (/dev/fd/3)
/// unless these are terminals, pipes or the like.
void CheckWritable(const std::filesystem::path& path);

/// Tells whether the two names lead to one file, which need not exist.
[[nodiscard]] bool AreSameFile(const std::filesystem::path& first,
                               const std::filesystem::path& second);

}  // namespace elastimate

#endif  // ELASTIMATE_IO_TEXT_FILE_OUTPUT_H_
