#include "benchmarks/child_process.h"

#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <chrono>
#include <csignal>
#include <exception>
#include <fstream>
#include <new>
#include <stdexcept>
#include <thread>

namespace elastimate {
namespace {

constexpr int kOutOfMemory = 3;
constexpr int kFailed = 4;
constexpr std::chrono::milliseconds kPollInterval{5};

[[noreturn]] void RunChild(int pipe, int processor_seconds,
                           const std::function<std::string()>& work) {
  // At the first limit the child gets SIGXCPU, by which the parent knows the
  // reason.  At the second it gets SIGKILL.
  const rlimit limit = {rlim_t(processor_seconds),
                        rlim_t(processor_seconds) + 1};
  setrlimit(RLIMIT_CPU, &limit);
  const auto send = [pipe](const std::string& text) {
    return write(pipe, text.data(), text.size()) == ssize_t(text.size());
  };
  try {
    _exit(send(work()) ? 0 : kFailed);
  } catch (const std::bad_alloc&) {
    _exit(kOutOfMemory);
  } catch (const std::exception& error) {
    send(error.what());
    _exit(kFailed);
  }
}

std::int64_t ResidentMemory(pid_t process) {
  std::ifstream file("/proc/" + std::to_string(process) + "/statm");
  std::int64_t size = 0;
  std::int64_t resident = 0;
  file >> size >> resident;
  return resident * sysconf(_SC_PAGESIZE);
}

std::string ReadAll(int pipe) {
  std::string text;
  std::array<char, 4096> buffer;
  for (ssize_t size; (size = read(pipe, buffer.data(), buffer.size())) > 0;) {
    text.append(buffer.data(), size);
  }
  return text;
}

}  // namespace

ProcessReport RunInChildProcess(const ProcessLimits& limits,
                                const std::function<std::string()>& work) {
  std::array<int, 2> pipe_ends;
  if (pipe(pipe_ends.data()) != 0) {
    throw std::runtime_error("no pipe to a child process can be opened");
  }
  const pid_t child = fork();
  if (child < 0) {
    throw std::runtime_error("no child process can be started");
  }
  if (child == 0) {
    close(pipe_ends[0]);
    RunChild(pipe_ends[1], limits.processor_seconds, work);
  }
  close(pipe_ends[1]);
  // The parent watches the memory, because a limit of the address space would
  // count what is reserved and never used.
  bool is_too_large = false;
  int status = 0;
  rusage usage{};
  while (wait4(child, &status, WNOHANG, &usage) == 0) {
    if (ResidentMemory(child) > limits.memory) {
      is_too_large = true;
      kill(child, SIGKILL);
    }
    std::this_thread::sleep_for(kPollInterval);
  }
  ProcessReport report = {ProcessOutcome::kFinished, ReadAll(pipe_ends[0]),
                          std::int64_t{usage.ru_maxrss} * 1024};
  close(pipe_ends[0]);
  if (is_too_large ||
      (WIFEXITED(status) && WEXITSTATUS(status) == kOutOfMemory)) {
    report.outcome = ProcessOutcome::kMemoryLimit;
  } else if (WIFSIGNALED(status) && WTERMSIG(status) == SIGXCPU) {
    report.outcome = ProcessOutcome::kTimeLimit;
  } else if (!WIFEXITED(status) || WEXITSTATUS(status) != 0) {
    throw std::runtime_error("a child process of the study failed: " +
                             report.output);
  }
  return report;
}

}  // namespace elastimate
