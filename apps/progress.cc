#include "apps/progress.h"

#include <unistd.h>

#include <chrono>
#include <iostream>

namespace elastimate {
namespace {

constexpr const char* kClearLine = "\r\033[K";
constexpr std::chrono::seconds kDelay(2);
constexpr std::chrono::milliseconds kInterval(500);

}  // namespace

Progress::Progress(const std::string& text) : text_(text) {
  if (isatty(STDERR_FILENO) != 0) {
    thread_ = std::thread(&Progress::Run, this);
  }
}

Progress::~Progress() {
  if (thread_.joinable()) {
    {
      const std::lock_guard<std::mutex> lock(mutex_);
      is_done_ = true;
    }
    stop_.notify_all();
    thread_.join();
  }
}

void Progress::Show(const std::string& text) {
  const std::lock_guard<std::mutex> lock(mutex_);
  text_ = text;
}

void Progress::Run() {
  const auto start = std::chrono::steady_clock::now();
  const auto is_done = [this] { return is_done_; };
  std::unique_lock<std::mutex> lock(mutex_);
  if (stop_.wait_for(lock, kDelay, is_done)) {
    return;
  }
  do {
    const auto seconds = std::chrono::duration_cast<std::chrono::seconds>(
                             std::chrono::steady_clock::now() - start)
                             .count();
    std::cerr << kClearLine << text_ << " (" << seconds << " s)" << std::flush;
  } while (!stop_.wait_for(lock, kInterval, is_done));
  std::cerr << kClearLine << std::flush;
}

}  // namespace elastimate
