#include "elastimate/core/large_strain/yeoh_law.h"

#include "elastimate/core/large_strain/isochoric.h"
#include "elastimate/core/laws/law_parameters.h"

namespace elastimate {

std::string_view YeohLaw::Description() const {
  return "large strains: rubber that stiffens where it is stretched far, of "
         "Yeoh";
}

const std::vector<LawParameter>& YeohLaw::Parameters() const {
  static const std::vector<LawParameter> parameters = {
      Modulus("c10", "c10", 1), SignedModulus("c20", "c20", -0.02, 0),
      SignedModulus("c30", "c30", 0.001, 0),
      Modulus("bulk_modulus", "kappa", 5)};
  return parameters;
}

void YeohLaw::DerivativesAtPoints(const PointInvariants& at, int count,
                                  PointDerivatives* of_moduli) const {
  for (int p = 0; p < count; ++p) {
    const FirstIsochoric first(at, p);
    double power = 1;  // A^(n - 1).
    double lower = 0;  // A^(n - 2), which counts from n = 2 on.
    for (int n = 1; n <= 3; ++n) {
      PointDerivatives& w = of_moduli[n - 1];
      const double slope = n * power;
      const double curvature = n * (n - 1) * lower;
      w.energy[p] = power * first.value;
      w.w1[p] = slope * first.a1;
      w.rest[p] = slope * first.rest;
      w.w11[p] = curvature * first.a1 * first.a1;
      w.w1j[p] = slope * first.a1j + curvature * first.a1 * first.aj;
      w.wjj[p] = slope * first.ajj + curvature * first.aj * first.aj;
      lower = power;
      power *= first.value;
    }
  }
  SetVolumeEnergy(at, count, of_moduli[3]);
}

}  // namespace elastimate
