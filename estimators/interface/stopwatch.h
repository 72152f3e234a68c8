#ifndef ELASTIMATE_ESTIMATORS_INTERFACE_STOPWATCH_H_
#define ELASTIMATE_ESTIMATORS_INTERFACE_STOPWATCH_H_

#include <chrono>

namespace elastimate {

/// The seconds since it was made, or since its last lap.
class Stopwatch {
 public:
  double Lap() {
    const auto now = std::chrono::steady_clock::now();
    const double seconds = std::chrono::duration<double>(now - last_).count();
    last_ = now;
    return seconds;
  }

 private:
  std::chrono::steady_clock::time_point last_ =
      std::chrono::steady_clock::now();
};

}  // namespace elastimate

#endif  // ELASTIMATE_ESTIMATORS_INTERFACE_STOPWATCH_H_
