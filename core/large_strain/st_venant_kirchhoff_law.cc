#include "elastimate/core/large_strain/st_venant_kirchhoff_law.h"

namespace elastimate {

std::string_view StVenantKirchhoffLaw::Description() const {
  return "large rotations: Hooke's law between Green's strain and the second "
         "Piola-Kirchhoff stress";
}

void StVenantKirchhoffLaw::DerivativesAtPoints(
    const PointInvariants& at, int count, PointDerivatives* of_moduli) const {
  PointDerivatives& mu = of_moduli[0];
  PointDerivatives& lambda = of_moduli[1];
  for (int p = 0; p < count; ++p) {
    const double t = at.t[p];
    // E : E = (I1^2 - 2 I2 - 2 I1 + 3) / 4.
    mu.energy[p] = t * t - at.s[p];
    mu.w1[p] = 1 + t;
    mu.w2[p] = -0.5;
    mu.rest[p] = 2 * t;
    mu.w11[p] = 0.5;
    lambda.energy[p] = t * t / 2;
    lambda.w1[p] = t / 2;
    lambda.rest[p] = t;
    lambda.w11[p] = 0.25;
  }
}

}  // namespace elastimate
