#include "elastimate/core/materials/laws.h"

#include <algorithm>
#include <sstream>

#include "elastimate/core/materials/anisotropic_law.h"
#include "elastimate/core/materials/free_axis_law.h"
#include "elastimate/core/materials/isotropic_law.h"
#include "elastimate/core/materials/orthotropic_law.h"
#include "elastimate/core/materials/transversely_isotropic_law.h"

namespace elastimate {
namespace {

template <class Predicate>
std::string NamesOf(const Predicate& is_named) {
  std::vector<std::string_view> names;
  std::string list;
  for (const Law* const law : Laws()) {
    if (is_named(*law) &&
        std::find(names.begin(), names.end(), law->Name()) == names.end()) {
      list += (names.empty() ? "" : ", ") + std::string(law->Name());
      names.push_back(law->Name());
    }
  }
  return list;
}

}  // namespace

const std::vector<const Law*>& Laws() {
  static const IsotropicLaw isotropic;
  static const TransverselyIsotropicLaw transversely_isotropic;
  static const FreeAxisLaw free_axis;
  static const OrthotropicLaw orthotropic(SectionModel::kSolid);
  static const OrthotropicLaw lamina(SectionModel::kPlaneStress);
  static const AnisotropicLaw anisotropic;
  static const std::vector<const Law*> laws = {
      &isotropic,  &transversely_isotropic, &free_axis, &orthotropic, &lamina,
      &anisotropic};
  return laws;
}

std::string LawNames() {
  return NamesOf([](const Law&) { return true; });
}

std::string LawNames(SectionModel model) {
  return NamesOf([model](const Law& law) { return law.Takes(model); });
}

std::string WhyOutOfRange(const LawParameter& parameter, double value) {
  if (value >= parameter.lower && value <= parameter.upper) {
    return "";
  }
  if (parameter.beside) {
    return "must be finite";
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

const Law* FindLaw(std::string_view name, SectionModel model) {
  for (const Law* const law : Laws()) {
    if (law->Name() == name && law->Takes(model)) {
      return law;
    }
  }
  return nullptr;
}

}  // namespace elastimate
