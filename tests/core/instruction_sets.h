#ifndef ELASTIMATE_TESTS_CORE_INSTRUCTION_SETS_H_
#define ELASTIMATE_TESTS_CORE_INSTRUCTION_SETS_H_

#include <gtest/gtest.h>
#include <hwy/targets.h>

#include <cstdint>
#include <string>
#include <vector>

namespace elastimate::testing {

/// Returns each kind of vector instruction that this processor has.  The least
/// is one that every processor of its architecture has.
inline std::vector<std::int64_t> InstructionSets() {
  std::vector<std::int64_t> targets;
  const auto supported =
      static_cast<std::uint64_t>(hwy::SupportedTargets() & HWY_TARGETS);
  for (int bit = 0; bit < 64; ++bit) {
    const std::uint64_t target = std::uint64_t{1} << bit;
    if ((supported & target) != 0) {
      targets.push_back(static_cast<std::int64_t>(target));
    }
  }
  return targets;
}

inline std::string InstructionSetName(
    const ::testing::TestParamInfo<std::int64_t>& test) {
  return hwy::TargetName(test.param);
}

/// The tests of such a suite run with the instructions that are their
/// parameter.
class InstructionSet : public ::testing::TestWithParam<std::int64_t> {
 protected:
  InstructionSet() { Choose(GetParam()); }
  ~InstructionSet() override { Choose(0); }

 private:
  static void Choose(std::int64_t targets) {
    hwy::SetSupportedTargetsForTest(targets);
    hwy::GetChosenTarget().Update(hwy::SupportedTargets());
  }
};

}  // namespace elastimate::testing

#endif  // ELASTIMATE_TESTS_CORE_INSTRUCTION_SETS_H_
