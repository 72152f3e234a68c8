#include "elastimate/io/helper/child_process.h"

#include <fcntl.h>
#include <poll.h>
#include <spawn.h>
#include <sys/types.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <csignal>
#include <new>
#include <stdexcept>
#include <system_error>

namespace elastimate {
namespace {

using Clock = std::chrono::steady_clock;

constexpr int kOutput = 3;  // A file descriptor of the child.
constexpr std::size_t kMaxErrors = 4096;

[[noreturn]] void ThrowNotStarted(const std::string& program, int error) {
  if (error == ENOMEM || error == EAGAIN) {
    throw std::bad_alloc();
  }
  throw std::runtime_error("the program " + program + " cannot be started (" +
                           std::generic_category().message(error) + ")");
}

/// A file descriptor that is closed with the object.
class File {
 public:
  File() = default;
  explicit File(int descriptor) : descriptor_(descriptor) {}
  ~File() { Close(); }
  File(const File&) = delete;
  File& operator=(const File&) = delete;

  void Reset(int descriptor) {
    Close();
    descriptor_ = descriptor;
  }
  void Close() {
    if (descriptor_ >= 0) {
      close(descriptor_);
      descriptor_ = -1;
    }
  }
  int Descriptor() const { return descriptor_; }

 private:
  int descriptor_ = -1;
};

/// Both ends are closed in every program that is started.
struct Pipe {
  File read_end;
  File write_end;

  explicit Pipe(const std::string& program) {
    std::array<int, 2> ends{};
    if (pipe2(ends.data(), O_CLOEXEC) != 0) {
      ThrowNotStarted(program, errno);
    }
    const File first(ends[0]);
    const File second(ends[1]);
    // Beyond those that the child sets up, one of which may be closed here.
    read_end.Reset(fcntl(ends[0], F_DUPFD_CLOEXEC, kOutput + 1));
    write_end.Reset(fcntl(ends[1], F_DUPFD_CLOEXEC, kOutput + 1));
    if (read_end.Descriptor() < 0 || write_end.Descriptor() < 0) {
      ThrowNotStarted(program, errno);
    }
  }
};

std::vector<char*> Pointers(const std::vector<std::string>& texts) {
  std::vector<char*> pointers;
  pointers.reserve(texts.size() + 1);
  for (const std::string& text : texts) {
    pointers.push_back(const_cast<char*>(text.c_str()));
  }
  pointers.push_back(nullptr);
  return pointers;
}

std::vector<std::string> Environment(const std::vector<std::string>& added) {
  std::vector<std::string> all = added;
  for (char** variable = environ; variable != nullptr && *variable != nullptr;
       ++variable) {
    const std::string text = *variable;
    const std::string begin = text.substr(0, text.find('=') + 1);
    if (std::none_of(added.begin(), added.end(), [&](const std::string& one) {
          return one.rfind(begin, 0) == 0;
        })) {
      all.push_back(text);
    }
  }
  return all;
}

class SpawnSettings {
 public:
  SpawnSettings(const Pipe& output, const Pipe& errors) {
    posix_spawn_file_actions_init(&actions_);
    posix_spawn_file_actions_addopen(&actions_, 0, "/dev/null", O_RDONLY, 0);
    posix_spawn_file_actions_addopen(&actions_, 1, "/dev/null", O_WRONLY, 0);
    posix_spawn_file_actions_adddup2(&actions_, errors.write_end.Descriptor(),
                                     2);
    posix_spawn_file_actions_adddup2(&actions_, output.write_end.Descriptor(),
                                     kOutput);
    posix_spawn_file_actions_addclosefrom_np(&actions_, kOutput + 1);
    posix_spawnattr_init(&attributes_);
    sigset_t signals;
    sigfillset(&signals);
    posix_spawnattr_setsigdefault(&attributes_, &signals);
    sigemptyset(&signals);
    posix_spawnattr_setsigmask(&attributes_, &signals);
    posix_spawnattr_setpgroup(&attributes_, 0);
    posix_spawnattr_setflags(&attributes_, POSIX_SPAWN_SETSIGDEF |
                                               POSIX_SPAWN_SETSIGMASK |
                                               POSIX_SPAWN_SETPGROUP);
  }
  ~SpawnSettings() {
    posix_spawnattr_destroy(&attributes_);
    posix_spawn_file_actions_destroy(&actions_);
  }
  SpawnSettings(const SpawnSettings&) = delete;
  SpawnSettings& operator=(const SpawnSettings&) = delete;

  pid_t Spawn(const std::string& program,
              const std::vector<std::string>& arguments,
              const std::vector<std::string>& environment) const {
    pid_t child = -1;
    const int error =
        posix_spawn(&child, program.c_str(), &actions_, &attributes_,
                    Pointers(arguments).data(), Pointers(environment).data());
    if (error != 0) {
      ThrowNotStarted(program, error);
    }
    return child;
  }

 private:
  posix_spawn_file_actions_t actions_{};
  posix_spawnattr_t attributes_{};
};

/// A process that does not outlive the object.
class Child {
 public:
  explicit Child(pid_t process) : process_(process) {}
  ~Child() {
    if (process_ > 0) {
      Kill();
      Wait();
    }
  }
  Child(const Child&) = delete;
  Child& operator=(const Child&) = delete;

  void Kill() const { kill(process_, SIGKILL); }

  /// The signal that ended it; 0 when it was none, or is not known.
  int Wait() {
    int status = 0;
    pid_t result = -1;
    do {
      result = waitpid(process_, &status, 0);
    } while (result < 0 && errno == EINTR);
    process_ = -1;
    return result > 0 && WIFSIGNALED(status) ? WTERMSIG(status) : 0;
  }

 private:
  pid_t process_;
};

/// Takes what there is to read, of which `text` keeps `max_size` bytes.  False
/// at the end.
bool TakeSome(const File& file, std::size_t max_size, std::string& text) {
  std::array<char, 1 << 16> buffer;
  const ssize_t size = read(file.Descriptor(), buffer.data(), buffer.size());
  if (size > 0) {
    text.append(buffer.data(),
                std::min<std::size_t>(size, max_size - text.size()));
  }
  return size > 0 || (size < 0 && (errno == EINTR || errno == EAGAIN));
}

/// Reads from both until both have ended, that is, the child has.  False when
/// that takes too long or is too much.
bool Drain(File& output, File& errors, Clock::time_point deadline,
           std::size_t max_output, ChildOutcome& outcome) {
  while (output.Descriptor() >= 0 || errors.Descriptor() >= 0) {
    const auto left = std::chrono::duration_cast<std::chrono::milliseconds>(
        deadline - Clock::now());
    if (left.count() <= 0 || outcome.output.size() >= max_output) {
      return false;
    }
    std::array<pollfd, 2> files = {
        {{output.Descriptor(), POLLIN, 0}, {errors.Descriptor(), POLLIN, 0}}};
    poll(files.data(), files.size(),
         static_cast<int>(std::min<std::int64_t>(left.count(), 60000)));
    if (files[0].revents != 0 &&
        !TakeSome(output, max_output, outcome.output)) {
      output.Close();
    }
    if (files[1].revents != 0 &&
        !TakeSome(errors, kMaxErrors, outcome.errors)) {
      errors.Close();
    }
  }
  return true;
}

}  // namespace

ChildOutcome RunChildProcess(const std::string& program,
                             const std::vector<std::string>& arguments,
                             const std::vector<std::string>& environment,
                             std::chrono::seconds limit,
                             std::size_t max_output) {
  const Clock::time_point deadline = Clock::now() + limit;
  Pipe output(program);
  Pipe errors(program);
  std::vector<std::string> all_arguments = {program};
  all_arguments.insert(all_arguments.end(), arguments.begin(), arguments.end());
  Child child(SpawnSettings(output, errors)
                  .Spawn(program, all_arguments, Environment(environment)));
  output.write_end.Close();
  errors.write_end.Close();
  ChildOutcome outcome;
  outcome.was_stopped =
      !Drain(output.read_end, errors.read_end, deadline, max_output, outcome);
  if (outcome.was_stopped) {
    child.Kill();
  }
  outcome.signal = child.Wait();
  return outcome;
}

}  // namespace elastimate
