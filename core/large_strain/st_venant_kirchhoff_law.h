#ifndef ELASTIMATE_CORE_LARGE_STRAIN_ST_VENANT_KIRCHHOFF_LAW_H_
#define ELASTIMATE_CORE_LARGE_STRAIN_ST_VENANT_KIRCHHOFF_LAW_H_

#include "elastimate/core/large_strain/charts.h"
#include "elastimate/core/large_strain/invariant_law.h"

namespace elastimate {

/// The law of St. Venant and Kirchhoff, Hooke's law between Green's strain
/// E = (F^T F - I) / 2 and the second Piola-Kirchhoff stress,
///
///   W = mu E : E + lambda / 2 (tr E)^2,   P = F (2 mu E + lambda tr(E) I)
///
/// [Holzapfel, Nonlinear Solid Mechanics, 2000, section 6.5].  It bears large
/// rotations, but loses its strength where it is pressed to about half of its
/// length.  The moduli are (mu, lambda).
class StVenantKirchhoffLaw : public LameLaw<InvariantLaw> {
 public:
  std::string_view Name() const override { return "st_venant_kirchhoff"; }
  std::string_view Description() const override;
  void DerivativesAtPoints(const PointInvariants& at, int count,
                           PointDerivatives* of_moduli) const override;
};

}  // namespace elastimate

#endif  // ELASTIMATE_CORE_LARGE_STRAIN_ST_VENANT_KIRCHHOFF_LAW_H_
