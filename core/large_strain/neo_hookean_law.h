#ifndef ELASTIMATE_CORE_LARGE_STRAIN_NEO_HOOKEAN_LAW_H_
#define ELASTIMATE_CORE_LARGE_STRAIN_NEO_HOOKEAN_LAW_H_

#include "elastimate/core/large_strain/charts.h"
#include "elastimate/core/large_strain/invariant_law.h"

namespace elastimate {

/// The neo-Hookean law of compressible rubber,
///
///   W = mu ((I1 - 3) / 2 - ln J) + lambda / 2 (ln J)^2,
///   P = mu (F - F^-T) + lambda ln J F^-T
///
/// [Bonet & Wood, Nonlinear Continuum Mechanics for Finite Element Analysis,
/// 2008, section 6.4].  The moduli are (mu, lambda).
class NeoHookeanLaw : public LameLaw<InvariantLaw> {
 public:
  std::string_view Name() const override { return "neo_hookean"; }
  std::string_view Description() const override;
  void DerivativesAtPoints(const PointInvariants& at, int count,
                           PointDerivatives* of_moduli) const override;
};

}  // namespace elastimate

#endif  // ELASTIMATE_CORE_LARGE_STRAIN_NEO_HOOKEAN_LAW_H_
