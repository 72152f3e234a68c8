#include "benchmarks/child_process.h"

#include <gtest/gtest.h>

#include <cstdint>
#include <new>
#include <stdexcept>
#include <string>
#include <vector>

namespace elastimate {
namespace {

constexpr std::int64_t kMebibyte = std::int64_t{1} << 20;
constexpr ProcessLimits kPlenty = {60, std::int64_t{8} << 30};

std::string Touch(std::int64_t size) {
  const std::vector<char> memory(size, 'x');
  return std::string(1, memory[size / 2]);
}

TEST(ChildProcess, ReportsOutputAndPeakMemory) {
  const ProcessReport small =
      RunInChildProcess(kPlenty, [] { return Touch(kMebibyte); });
  const ProcessReport large =
      RunInChildProcess(kPlenty, [] { return Touch(101 * kMebibyte); });
  EXPECT_EQ(small.outcome, ProcessOutcome::kFinished);
  EXPECT_EQ(small.output, "x");
  EXPECT_NEAR(static_cast<double>(large.peak_memory - small.peak_memory),
              100.0 * kMebibyte, 5.0 * kMebibyte);
}

TEST(ChildProcess, EndsAtTheTimeLimit) {
  const ProcessReport report =
      RunInChildProcess({1, kPlenty.memory}, []() -> std::string {
        for (volatile int i = 0;; i = i + 1) {
        }
      });
  EXPECT_EQ(report.outcome, ProcessOutcome::kTimeLimit);
}

TEST(ChildProcess, EndsAtTheMemoryLimit) {
  const ProcessLimits limits = {60, 1000 * kMebibyte};
  const ProcessReport report = RunInChildProcess(limits, []() -> std::string {
    std::string all;
    while (true) {
      all.append(kMebibyte, 'x');
    }
  });
  EXPECT_EQ(report.outcome, ProcessOutcome::kMemoryLimit);
  EXPECT_EQ(RunInChildProcess(kPlenty,
                              []() -> std::string { throw std::bad_alloc(); })
                .outcome,
            ProcessOutcome::kMemoryLimit);
}

TEST(ChildProcess, FailsWithItsWork) {
  EXPECT_THROW(RunInChildProcess(kPlenty,
                                 []() -> std::string {
                                   throw std::invalid_argument("of the work");
                                 }),
               std::runtime_error);
}

}  // namespace
}  // namespace elastimate
