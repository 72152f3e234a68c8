#include "elastimate/core/materials/laws.h"

#include <sstream>

#include "elastimate/core/materials/isotropic_law.h"

namespace elastimate {

const std::vector<const Law*>& Laws() {
  static const IsotropicLaw isotropic;
  static const std::vector<const Law*> laws = {&isotropic};
  return laws;
}

std::string LawNames() {
  std::string names;
  for (const Law* const law : Laws()) {
    names += (names.empty() ? "" : ", ") + std::string(law->Name());
  }
  return names;
}

std::string WhyOutOfRange(const LawParameter& parameter, double value) {
  if (value >= parameter.lower && value <= parameter.upper) {
    return "";
  }
  if (parameter.is_modulus) {
    return "must be positive and finite";
  }
  std::ostringstream why;
  why << "must be between " << parameter.lower << " and " << parameter.upper;
  return why.str();
}

const Law* FindLaw(std::string_view name) {
  for (const Law* const law : Laws()) {
    if (law->Name() == name) {
      return law;
    }
  }
  return nullptr;
}

}  // namespace elastimate
