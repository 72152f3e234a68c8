#ifndef ELASTIMATE_APPS_PROGRESS_H_
#define ELASTIMATE_APPS_PROGRESS_H_

#include <condition_variable>
#include <mutex>
#include <string>
#include <thread>

namespace elastimate {

/// Shows on one line of standard error what long work is at, and for how long.
/// It does so only when that is a terminal, and only after two seconds.  The
/// line is cleared at the end.
class Progress {
 public:
  explicit Progress(const std::string& text);
  ~Progress();
  Progress(const Progress&) = delete;
  Progress& operator=(const Progress&) = delete;

  /// Sets what the work is at from now on.
  void Show(const std::string& text);

 private:
  void Run();

  std::mutex mutex_;
  std::condition_variable stop_;
  std::string text_;
  bool is_done_ = false;
  std::thread thread_;  ///< Not running unless standard error is a terminal.
};

}  // namespace elastimate

#endif  // ELASTIMATE_APPS_PROGRESS_H_
