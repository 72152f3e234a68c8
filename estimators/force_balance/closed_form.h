#ifndef ELASTIMATE_ESTIMATORS_FORCE_BALANCE_CLOSED_FORM_H_
#define ELASTIMATE_ESTIMATORS_FORCE_BALANCE_CLOSED_FORM_H_

#include "elastimate/estimators/interface/estimator.h"

namespace elastimate {

/// The least force residual over the mean stiffness (RegressForces).  For one
/// isotropic material it is the linear least squares of Becker & Teschner 2007:
///
///   min over (nu, t) of ||a + nu b - t f||,  a = H q, b = J q   [eq. 21, 23]
///   t = f.(a + nu b) / f.f  for a known nu                      [eq. 20]
///   E = (1 + nu)(1 - 2 nu) / t
///
/// over the free rows of all load cases, solved through a QR factorisation.
///
/// Needs the displacement of every free node; needs no supports.  Exact for
/// data from the same mesh without noise.  Displacement noise pulls nu towards
/// 2/3 and E towards and below zero, the more the finer the mesh: the estimate
/// says itself when that makes it unusable.  With a known nu, E has no bias.
///
/// Cost: that of RegressForces; no factorisation.  Single-threaded,
/// deterministic.
class ClosedForm : public Estimator {
 public:
  std::string_view Name() const override;
  std::string_view Description() const override;
  Capabilities WhatItTakes() const override;

 protected:
  Estimate DoRun(const Scene& scene,
                 const EstimatorOptions& options) const override;
  std::unique_ptr<Preparation> DoPrepare(
      const Scene& scene, const EstimatorOptions& options) const override;
};

}  // namespace elastimate

#endif  // ELASTIMATE_ESTIMATORS_FORCE_BALANCE_CLOSED_FORM_H_
