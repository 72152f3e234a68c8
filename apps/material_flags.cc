#include "apps/material_flags.h"

#include <algorithm>
#include <stdexcept>
#include <string>
#include <string_view>

#include "apps/flags.h"
#include "apps/number_list.h"
#include "elastimate/core/materials/isotropic_law.h"
#include "elastimate/core/materials/laws.h"
#include "elastimate/core/materials/orthotropic_law.h"
#include "elastimate/core/materials/transversely_isotropic_law.h"

namespace elastimate {
namespace {

// Returns one direction of 2 or 3 numbers, or two of 3 each.
std::vector<Eigen::VectorXd> AxesFromFlag() {
  const Eigen::Index count =
      1 + std::count(FLAGS_axis.begin(), FLAGS_axis.end(), ',');
  const bool is_known = count == 2 || count == 3 || count == 6;
  const auto numbers = NumberList<Eigen::VectorXd>(
      "axis", FLAGS_axis, "numbers (of two axes six), or free",
      is_known ? count : 3);
  if (count == 6) {
    return {numbers.head(3), numbers.tail(3)};
  }
  return {numbers};
}

void GiveAxes(LawChoice& choice) {
  choice.has_free_axis = FLAGS_axis == "free";
  if (!choice.has_free_axis) {
    choice.axes = AxesFromFlag();
  }
}

}  // namespace

LawChoice LawFromFlags() {
  LawChoice choice;
  if (IsGiven("material")) {
    choice.law = FLAGS_material;
    if (FindLaw(choice.law) == nullptr) {
      throw std::invalid_argument(AsGiven("material") + "; it must be one of " +
                                  LawNames() + " (auto is for estimate only)");
    }
  }
  if (IsGiven("axis")) {
    GiveAxes(choice);
  }
  return choice;
}

bool ChoosesLaw() { return FLAGS_material == "auto"; }

LawChoice AxesOfLawsToChoose() {
  LawChoice choice;
  if (IsGiven("axis")) {
    GiveAxes(choice);
    choice.law = choice.axes.size() == 2
                     ? std::string_view(OrthotropicLaw::kName)
                     : std::string_view(TransverselyIsotropicLaw::kName);
  }
  return choice;
}

std::string FieldFromFlag() {
  if (!IsGiven("map")) {
    return "";
  }
  if (FLAGS_map != "youngs_modulus") {
    throw std::invalid_argument(AsGiven("map") + "; it must be youngs_modulus");
  }
  const bool is_other_law =
      IsGiven("material") && FLAGS_material != IsotropicLaw::kName;
  const bool has_regions = IsGiven("regions") && FLAGS_regions != "one";
  if (is_other_law || has_regions) {
    throw std::invalid_argument(
        "--map is for one isotropic material; leave out " +
        AsGiven(is_other_law ? "material" : "regions"));
  }
  return FLAGS_map;
}

}  // namespace elastimate
