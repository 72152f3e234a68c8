#include "elastimate/petsc/petsc_module.h"

#include <fcntl.h>
#include <petscsys.h>
#include <poll.h>
#include <sys/wait.h>
#include <unistd.h>

#include <csignal>
#include <cstdlib>
#include <mutex>
#include <optional>
#include <string>

namespace elastimate {
namespace {

// Tells whether MPI can be started here.  Where it cannot (no folder for
// temporary files, no network interface, few files), it ends the process that
// tries.
bool CanStartMpi() {
  constexpr int kMostMilliseconds = 20000;
  int ends[2];
  if (pipe(ends) != 0) {
    return false;
  }
  const pid_t child = fork();
  if (child == 0) {
    const int nowhere = open("/dev/null", O_WRONLY);
    dup2(nowhere, STDOUT_FILENO);
    dup2(nowhere, STDERR_FILENO);
    const bool is_started = MPI_Init(nullptr, nullptr) == MPI_SUCCESS &&
                            MPI_Finalize() == MPI_SUCCESS;
    const char answer = 'y';
    _exit(is_started && write(ends[1], &answer, 1) == 1 ? 0 : 1);
  }
  close(ends[1]);
  char answer = 'n';
  if (child > 0) {
    pollfd answered = {ends[0], POLLIN, 0};
    if (poll(&answered, 1, kMostMilliseconds) <= 0 ||
        read(ends[0], &answer, 1) != 1) {
      answer = 'n';
    }
    kill(child, SIGKILL);
    waitpid(child, nullptr, 0);
  }
  close(ends[0]);
  return answer == 'y';
}

// Starts PETSc without options from files or the environment and without
// handlers of signals, which a program does not want that only has its
// equations solved.
bool InitializeWithoutOptions() {
  const char* const given = std::getenv("PETSC_OPTIONS");
  const std::optional<std::string> options =
      given == nullptr ? std::nullopt : std::optional<std::string>(given);
  unsetenv("PETSC_OPTIONS");
  PetscOptionsSetValue(nullptr, "-skip_petscrc", "true");
  PetscOptionsSetValue(nullptr, "-no_signal_handler", "true");
  const bool is_started = PetscInitializeNoArguments() == 0;
  if (options) {
    setenv("PETSC_OPTIONS", options->c_str(), 1);
  }
  return is_started;
}

void Start() {
  static std::mutex mutex;
  const std::lock_guard lock(mutex);
  PetscBool is_running = PETSC_FALSE;
  PetscInitialized(&is_running);
  PetscBool has_ended = PETSC_FALSE;
  PetscFinalized(&has_ended);
  if (is_running == PETSC_TRUE || has_ended == PETSC_TRUE) {
    return;
  }
  int has_mpi = 0;
  MPI_Initialized(&has_mpi);
  const bool is_rank = NumStarted().has_value();
  if (!is_rank) {
    // One process needs no daemon to start others.
    setenv("OMPI_MCA_ess_singleton_isolated", "1", 0);
  }
  // Solves may come from any thread, one at a time.
  PETSC_MPI_THREAD_REQUIRED = MPI_THREAD_SERIALIZED;
  if ((has_mpi != 0 || is_rank || CanStartMpi()) &&
      InitializeWithoutOptions()) {
    std::atexit([] { PetscFinalize(); });
  }
}

}  // namespace
}  // namespace elastimate

void elastimate_start_petsc() { elastimate::Start(); }
