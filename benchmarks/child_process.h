#ifndef ELASTIMATE_BENCHMARKS_CHILD_PROCESS_H_
#define ELASTIMATE_BENCHMARKS_CHILD_PROCESS_H_

#include <cstdint>
#include <functional>
#include <string>

namespace elastimate {

/// Limits what a child process may use.
struct ProcessLimits {
  int processor_seconds;
  std::int64_t memory;  ///< Resident [byte].
};

enum class ProcessOutcome { kFinished, kTimeLimit, kMemoryLimit };

struct ProcessReport {
  ProcessOutcome outcome;
  std::string output;            ///< What `work` returned, when it finished.
  std::int64_t peak_memory = 0;  ///< Resident [byte].
};

/// Runs `work` in a fork of this process, so that its peak memory is its own.
/// A limit ends it; so does std::bad_alloc, which counts as the memory limit.
/// Throws std::runtime_error when the child fails in any other way.
/// Precondition: `output` of work is shorter than a pipe holds (64 KiB).
ProcessReport RunInChildProcess(const ProcessLimits& limits,
                                const std::function<std::string()>& work);

}  // namespace elastimate

#endif  // ELASTIMATE_BENCHMARKS_CHILD_PROCESS_H_
