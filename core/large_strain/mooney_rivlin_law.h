#ifndef ELASTIMATE_CORE_LARGE_STRAIN_MOONEY_RIVLIN_LAW_H_
#define ELASTIMATE_CORE_LARGE_STRAIN_MOONEY_RIVLIN_LAW_H_

#include "elastimate/core/large_strain/charts.h"
#include "elastimate/core/large_strain/invariant_law.h"

namespace elastimate {

/// The law of Mooney and Rivlin of nearly incompressible rubber,
///
///   W = c10 (I1 J^(-2/3) - 3) + c01 (I2 J^(-4/3) - 3) + kappa / 2 (J - 1)^2
///
/// [Holzapfel, Nonlinear Solid Mechanics, 2000, section 6.5].  The moduli are
/// the parameters (c10, c01, kappa).  The shear modulus of small strains is
/// 2 (c10 + c01).
class MooneyRivlinLaw : public OwnModuliLaw<InvariantLaw> {
 public:
  std::string_view Name() const override { return "mooney_rivlin"; }
  std::string_view Description() const override;
  const std::vector<LawParameter>& Parameters() const override;
  void DerivativesAtPoints(const PointInvariants& at, int count,
                           PointDerivatives* of_moduli) const override;
};

}  // namespace elastimate

#endif  // ELASTIMATE_CORE_LARGE_STRAIN_MOONEY_RIVLIN_LAW_H_
