#include "apps/material_flags.h"

#include <algorithm>
#include <stdexcept>
#include <string>

#include "apps/flags.h"
#include "apps/number_list.h"
#include "elastimate/core/materials/laws.h"

namespace elastimate {
namespace {

// One direction of 2 or 3 numbers, or two of 3 each.
std::vector<Eigen::VectorXd> AxesFromFlag() {
  const Eigen::Index count =
      1 + std::count(FLAGS_axis.begin(), FLAGS_axis.end(), ',');
  const bool is_known = count == 2 || count == 3 || count == 6;
  const auto numbers = NumberList<Eigen::VectorXd>(
      "axis", FLAGS_axis, "numbers (of two axes six)", is_known ? count : 3);
  if (count == 6) {
    return {numbers.head(3), numbers.tail(3)};
  }
  return {numbers};
}

}  // namespace

LawChoice LawFromFlags() {
  LawChoice choice;
  if (IsGiven("material")) {
    choice.law = FLAGS_material;
    if (FindLaw(choice.law) == nullptr) {
      throw std::invalid_argument(AsGiven("material") + "; the laws are " +
                                  LawNames());
    }
  }
  if (IsGiven("axis")) {
    choice.axes = AxesFromFlag();
  }
  return choice;
}

}  // namespace elastimate
