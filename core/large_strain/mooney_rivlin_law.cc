#include "elastimate/core/large_strain/mooney_rivlin_law.h"

#include "elastimate/core/large_strain/isochoric.h"
#include "elastimate/core/laws/law_parameters.h"

namespace elastimate {

std::string_view MooneyRivlinLaw::Description() const {
  return "large strains: nearly incompressible rubber of Mooney and Rivlin";
}

const std::vector<LawParameter>& MooneyRivlinLaw::Parameters() const {
  static const std::vector<LawParameter> parameters = {
      Modulus("c10", "c10", 1), SignedModulus("c01", "c01", 0.25, 0),
      Modulus("bulk_modulus", "kappa", 5)};
  return parameters;
}

void MooneyRivlinLaw::DerivativesAtPoints(const PointInvariants& at, int count,
                                          PointDerivatives* of_moduli) const {
  PointDerivatives& c10 = of_moduli[0];
  PointDerivatives& c01 = of_moduli[1];
  for (int p = 0; p < count; ++p) {
    const FirstIsochoric first(at, p);
    c10.energy[p] = first.value;
    c10.w1[p] = first.a1;
    c10.rest[p] = first.rest;
    c10.w1j[p] = first.a1j;
    c10.wjj[p] = first.ajj;
    // B = I2 J^(-4/3) - 3.
    const double jacobian = 1 + at.j[p];
    const double i2 = 3 + 4 * at.t[p] + 2 * at.s[p];
    c01.energy[p] = at.b[p];
    c01.w2[p] = first.a1 * first.a1;
    c01.w2j[p] = -4 * c01.w2[p] / (3 * jacobian);
    c01.rest[p] = -c01.w2j[p] * (3 * at.j[p] - 4 * at.t[p] - 2 * at.s[p]);
    c01.wjj[p] = -7 * c01.w2j[p] * i2 / (3 * jacobian);
  }
  SetVolumeEnergy(at, count, of_moduli[2]);
}

}  // namespace elastimate
