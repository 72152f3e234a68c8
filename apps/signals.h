#ifndef ELASTIMATE_APPS_SIGNALS_H_
#define ELASTIMATE_APPS_SIGNALS_H_

namespace elastimate {

/// Lets a signal that ends the program (SIGHUP, SIGINT, SIGQUIT, SIGTERM) first
/// remove the outputs that are not yet whole.  Signals that the caller has told
/// the program to ignore stay ignored.  To be called by the main thread, which
/// is the only one that may write outputs.
void CleanUpOnSignals();

/// Ends the program as SIGPIPE ends one that does not ignore it, and leaves no
/// part of an output.
[[noreturn]] void EndByClosedPipe();

}  // namespace elastimate

#endif  // ELASTIMATE_APPS_SIGNALS_H_
