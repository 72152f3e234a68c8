#ifndef ELASTIMATE_CORE_LAWS_LAW_PARAMETERS_H_
#define ELASTIMATE_CORE_LAWS_LAW_PARAMETERS_H_

#include <array>
#include <limits>
#include <string_view>

#include "elastimate/core/laws/law.h"

namespace elastimate {

/// A modulus of any positive value.
inline LawParameter Modulus(std::string_view name, std::string_view symbol,
                            double typical) {
  return {name,
          symbol,
          true,
          std::numeric_limits<double>::min(),
          std::numeric_limits<double>::max(),
          typical};
}

/// A stiffness of either sign, in units of the modulus that is the parameter of
/// this place.
inline LawParameter SignedModulus(std::string_view name,
                                  std::string_view symbol, double typical,
                                  int unit) {
  return {name,
          symbol,
          false,
          std::numeric_limits<double>::lowest(),
          std::numeric_limits<double>::max(),
          typical,
          std::array<int, 2>{unit, unit}};
}

/// Poisson's ratio of one direction to another in a material that is not alike
/// in all directions: its square is below the ratio of the two moduli, whatever
/// that is.
inline LawParameter DirectedPoissonRatio(std::string_view name,
                                         std::string_view symbol) {
  constexpr double kLargest = 100;
  return {name, symbol, false, -kLargest, kLargest, 0.3};
}

/// Poisson's ratio in a plane that is alike in all directions, between -1 and 1
/// whatever is across it.
inline LawParameter PoissonRatioInPlane(std::string_view name,
                                        std::string_view symbol) {
  constexpr double kLargest = 0.9999;
  return {name, symbol, false, -kLargest, kLargest, 0.3};
}

/// The shear modulus of an isotropic material of E = 1, nu = 0.3.
inline constexpr double kTypicalShearModulus = 1 / 2.6;

}  // namespace elastimate

#endif  // ELASTIMATE_CORE_LAWS_LAW_PARAMETERS_H_
