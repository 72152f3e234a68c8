#include "elastimate/io/helper/mesh_program_call.h"

#include <sys/resource.h>
#include <unistd.h>

#include <chrono>
#include <csignal>
#include <limits>
#include <new>
#include <stdexcept>
#include <utility>

#include "elastimate/core/package/package_file.h"
#include "elastimate/io/helper/child_process.h"
#include "elastimate/io/helper/mesh_message.h"
#include "elastimate/io/text/input_error.h"

namespace elastimate {
namespace {

/// The limits are zero where there are none.
struct Limits {
  std::uint64_t processor_seconds = 0;
  std::uint64_t memory = 0;
};

/// Allows about ten times what good files need.
Limits LimitsOf(const std::filesystem::path& path) {
  const std::uint64_t size = std::filesystem::file_size(path);
  return {10 + size / 1'000'000, 512'000'000 + 60 * size};
}

/// Runs the program with the arguments.
std::pair<ChildOutcome, MeshMessage> Run(
    const MeshProgram& program, const Limits& limits,
    const std::vector<std::string>& arguments) {
  const std::string file = FindPackageFile(program.file);
  if (file.empty()) {
    throw std::runtime_error(
        "the program " + program.file + ", which " + program.purpose +
        ", is not found; install it with the libraries, or name its folder in "
        "LD_LIBRARY_PATH");
  }
  std::vector<std::string> all = {std::to_string(getpid()),
                                  std::to_string(limits.processor_seconds),
                                  std::to_string(limits.memory)};
  all.insert(all.end(), arguments.begin(), arguments.end());
  // One thread does the work; others would only take memory.  The program may
  // wait for a processor or a disk ten times as long as it works.
  const bool is_limited = limits.processor_seconds > 0;
  ChildOutcome outcome = RunChildProcess(
      file, all, {"OMP_NUM_THREADS=1", "OPENBLAS_NUM_THREADS=1"},
      is_limited ? std::chrono::seconds(60 + 10 * limits.processor_seconds)
                 : std::chrono::hours(24 * 365),
      is_limited ? limits.memory : std::numeric_limits<std::size_t>::max());
  MeshMessage message = ParseMeshMessage(outcome.output);
  outcome.output.clear();
  return {std::move(outcome), std::move(message)};
}

bool HasLimitOfMemory() {
  rlimit limit{};
  return getrlimit(RLIMIT_AS, &limit) == 0 && limit.rlim_cur != RLIM_INFINITY;
}

/// Throws for a program that did not start its work, or was kept from it.
void CheckItCouldWork(const MeshProgram& program, const ChildOutcome& outcome,
                      const MeshMessage& message) {
  using Kind = MeshMessage::Kind;
  // The kernel kills a process that takes the last memory.
  const bool was_killed = outcome.signal == SIGKILL && !outcome.was_stopped;
  const bool is_unable =
      message.kind == Kind::kNone || message.kind == Kind::kOutOfMemory;
  if (was_killed || (is_unable && message.is_short_of_memory) ||
      (!message.has_started && HasLimitOfMemory())) {
    throw std::bad_alloc();
  }
  if (!message.has_started && !outcome.was_stopped) {
    const std::string reason = outcome.errors.substr(0, 500);
    throw std::runtime_error("the program " + program.file + ", which " +
                             program.purpose + ", does not start (" +
                             reason.substr(0, reason.find('\n')) + ")");
  }
}

/// Describes what a file did to the program.
std::string DescribeEnd(const MeshProgram& program, const Limits& limits,
                        const ChildOutcome& outcome,
                        const MeshMessage& message) {
  if (outcome.was_stopped || outcome.signal == SIGXCPU) {
    return program.library + " does not finish with it within " +
           std::to_string(limits.processor_seconds) + " s";
  }
  if (message.kind == MeshMessage::Kind::kOutOfMemory) {
    return program.library + " needs more than " +
           std::to_string(limits.memory / 1'000'000) +
           " MB for it, as for numbers that are far too large";
  }
  return program.library + " crashes on it";
}

}  // namespace

MeshFile ReadByProgram(const MeshProgram& program,
                       const std::vector<std::string>& arguments,
                       const std::filesystem::path& path) {
  const Limits limits = LimitsOf(path);
  std::vector<std::string> all = arguments;
  all.push_back(path.string());
  auto [outcome, message] = Run(program, limits, all);
  CheckItCouldWork(program, outcome, message);
  switch (message.kind) {
    case MeshMessage::Kind::kMesh:
      message.mesh.path = path;
      return std::move(message.mesh);
    case MeshMessage::Kind::kWrongInput:
      throw std::invalid_argument(message.sentence);
    case MeshMessage::Kind::kFailure:
      throw std::runtime_error(message.sentence);
    default:
      ThrowInputError(path, "the file is damaged or of another format (" +
                                DescribeEnd(program, limits, outcome, message) +
                                "); " + program.mend);
  }
}

MeshFile MakeByProgram(const MeshProgram& program,
                       const std::vector<std::string>& arguments) {
  auto [outcome, message] = Run(program, Limits(), arguments);
  CheckItCouldWork(program, outcome, message);
  switch (message.kind) {
    case MeshMessage::Kind::kMesh:
      return std::move(message.mesh);
    case MeshMessage::Kind::kOutOfMemory:
      throw std::bad_alloc();
    case MeshMessage::Kind::kNone:
      throw std::runtime_error(program.library + " crashed.");
    default:
      throw std::runtime_error(message.sentence);
  }
}

}  // namespace elastimate
