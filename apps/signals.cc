#include "apps/signals.h"

#include <pthread.h>
#include <unistd.h>

#include <cerrno>
#include <csignal>

#include "elastimate/io/text/file_output.h"

namespace elastimate {
namespace {

pthread_t main_thread;

// Ends the program so that whoever waits for it sees that a signal ended it.
void EndBySignal(int signal_number) {
  UnlinkStagedFiles();
  signal(signal_number, SIG_DFL);
  raise(signal_number);
}

// The main thread removes the outputs, because it writes them and must not make
// another one after they are removed.
void CleanUpAndEnd(int signal_number) {
  const int reason = errno;
  if (pthread_equal(pthread_self(), main_thread) == 0) {
    pthread_kill(main_thread, signal_number);
    errno = reason;
    return;
  }
  EndBySignal(signal_number);
}

}  // namespace

void CleanUpOnSignals() {
  main_thread = pthread_self();
  struct sigaction action = {};
  action.sa_handler = CleanUpAndEnd;
  action.sa_flags = SA_RESTART;
  for (const int signal_number : {SIGHUP, SIGINT, SIGQUIT, SIGTERM}) {
    struct sigaction previous = {};
    if (sigaction(signal_number, nullptr, &previous) == 0 &&
        previous.sa_handler != SIG_IGN) {
      sigaction(signal_number, &action, nullptr);
    }
  }
}

void EndByClosedPipe() {
  EndBySignal(SIGPIPE);
  _exit(128 + SIGPIPE);  // Where the signal is blocked: what shells make of it.
}

}  // namespace elastimate
