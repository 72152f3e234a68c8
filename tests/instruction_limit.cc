// Limits the vector instructions of a test program to those that the
// environment variable ELASTIMATE_TEST_INSTRUCTIONS names ("AVX2", "SCALAR",
// ...) and to lesser ones, as on a processor that has no others.

#include <hwy/targets.h>

#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <string>

namespace elastimate::testing {
namespace {

constexpr char kVariable[] = "ELASTIMATE_TEST_INSTRUCTIONS";

bool LimitInstructions() {
  const char* const name = std::getenv(kVariable);
  if (name == nullptr) {
    return false;
  }
  for (int bit = 0; bit < 63; ++bit) {
    const std::int64_t target = std::int64_t{1} << bit;
    if ((HWY_TARGETS & target) != 0 &&
        std::string(name) == hwy::TargetName(target)) {
      // Better ones have lower bits.
      hwy::DisableTargets(target - 1);
      return true;
    }
  }
  std::fprintf(stderr, "%s=%s: no such vector instructions\n", kVariable, name);
  std::exit(1);
}

[[maybe_unused]] const bool kIsLimited = LimitInstructions();

}  // namespace
}  // namespace elastimate::testing
