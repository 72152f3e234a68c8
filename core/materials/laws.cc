#include "elastimate/core/materials/laws.h"

#include "elastimate/core/materials/isotropic_law.h"

namespace elastimate {

const std::vector<const Law*>& Laws() {
  static const IsotropicLaw isotropic;
  static const std::vector<const Law*> laws = {&isotropic};
  return laws;
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
