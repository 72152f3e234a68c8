#include "elastimate/core/large_strain/neo_hookean_law.h"

namespace elastimate {

std::string_view NeoHookeanLaw::Description() const {
  return "large strains: the neo-Hookean law of compressible rubber";
}

void NeoHookeanLaw::DerivativesAtPoints(const PointInvariants& at, int count,
                                        PointDerivatives* of_moduli) const {
  PointDerivatives& mu = of_moduli[0];
  PointDerivatives& lambda = of_moduli[1];
  for (int p = 0; p < count; ++p) {
    const double inverse = 1 / (1 + at.j[p]);
    mu.energy[p] = at.t[p] - at.log_j[p];
    mu.w1[p] = 0.5;
    mu.rest[p] = at.j[p] * inverse;  // 1 - 1 / J.
    mu.wjj[p] = inverse * inverse;
    lambda.energy[p] = at.log_j[p] * at.log_j[p] / 2;
    lambda.rest[p] = at.log_j[p] * inverse;
    lambda.wjj[p] = (1 - at.log_j[p]) * inverse * inverse;
  }
}

}  // namespace elastimate
