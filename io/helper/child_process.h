#ifndef ELASTIMATE_IO_HELPER_CHILD_PROCESS_H_
#define ELASTIMATE_IO_HELPER_CHILD_PROCESS_H_

#include <chrono>
#include <cstddef>
#include <string>
#include <vector>

namespace elastimate {

/// What a process leaves behind.
struct ChildOutcome {
  std::string output;        ///< What it wrote to its file descriptor 3.
  std::string errors;        ///< The begin of what it wrote to standard error.
  bool was_stopped = false;  ///< It took too long, or wrote too much.
  int signal = 0;            ///< The one that ended it, where that is known.
};

/// Starts a program and waits for its end, at most for `limit`, and for
/// `max_output` bytes of output at most; then it is killed.  Its standard input
/// and output are /dev/null, its signals those of a new process, its process
/// group its own.  It inherits no file that is open, and has the environment
/// variables given, "NAME=VALUE", beside those of this process.
///
/// For concurrent calls in any program: it does not mind which files are open,
/// how signals are handled, or who else waits for child processes; only the
/// signal that ended the program is not known where the caller ignores SIGCHLD.
/// Throws std::runtime_error when the program cannot be started, and
/// std::bad_alloc where that is for lack of memory.
ChildOutcome RunChildProcess(const std::string& program,
                             const std::vector<std::string>& arguments,
                             const std::vector<std::string>& environment,
                             std::chrono::seconds limit,
                             std::size_t max_output);

}  // namespace elastimate

#endif  // ELASTIMATE_IO_HELPER_CHILD_PROCESS_H_
