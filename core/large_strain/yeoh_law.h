#ifndef ELASTIMATE_CORE_LARGE_STRAIN_YEOH_LAW_H_
#define ELASTIMATE_CORE_LARGE_STRAIN_YEOH_LAW_H_

#include "elastimate/core/large_strain/charts.h"
#include "elastimate/core/large_strain/invariant_law.h"

namespace elastimate {

/// The law of Yeoh of rubber that stiffens where it is stretched far,
///
///   W = c10 A + c20 A^2 + c30 A^3 + kappa / 2 (J - 1)^2,
///   A = I1 J^(-2/3) - 3
///
/// [Yeoh, Rubber Chem. Technol. 66 (1993) 754].  The moduli are the parameters
/// (c10, c20, c30, kappa).  The shear modulus of small strains is 2 c10.
class YeohLaw : public OwnModuliLaw<InvariantLaw> {
 public:
  std::string_view Name() const override { return "yeoh"; }
  std::string_view Description() const override;
  const std::vector<LawParameter>& Parameters() const override;
  void DerivativesAtPoints(const PointInvariants& at, int count,
                           PointDerivatives* of_moduli) const override;
};

}  // namespace elastimate

#endif  // ELASTIMATE_CORE_LARGE_STRAIN_YEOH_LAW_H_
