#include "benchmarks/metadata.h"

#include <unistd.h>

#include <ctime>
#include <fstream>
#include <iomanip>
#include <sstream>
#include <thread>

#include "apps/linear_algebra.h"
#include "elastimate_commit.h"

namespace elastimate {
namespace {

std::string ProcessorModel() {
  std::ifstream file("/proc/cpuinfo");
  std::string line;
  while (std::getline(file, line)) {
    const std::size_t colon = line.find(": ");
    if (line.rfind("model name", 0) == 0 && colon != std::string::npos) {
      return line.substr(colon + 2);
    }
  }
  return "unknown";
}

std::string Now() {
  const std::time_t now = std::time(nullptr);
  std::tm utc = {};
  gmtime_r(&now, &utc);
  std::ostringstream text;
  text << std::put_time(&utc, "%Y-%m-%dT%H:%M:%SZ");
  return text.str();
}

}  // namespace

nlohmann::ordered_json DescribeRun(const std::string& command) {
  constexpr double kGibibyte = 1024.0 * 1024.0 * 1024.0;
  const double memory = static_cast<double>(sysconf(_SC_PHYS_PAGES)) *
                        static_cast<double>(sysconf(_SC_PAGE_SIZE));
  return {{"command", command},
          {"date", Now()},
          {"commit", ELASTIMATE_COMMIT},
          {"compiler", ELASTIMATE_COMPILER},
          {"compiler_flags", ELASTIMATE_COMPILER_FLAGS},
          {"blas", DescribeBlas()},
          {"processor", ProcessorModel()},
          {"logical_processors", std::thread::hardware_concurrency()},
          {"memory_gib", memory / kGibibyte}};
}

}  // namespace elastimate
