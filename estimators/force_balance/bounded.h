#ifndef ELASTIMATE_ESTIMATORS_FORCE_BALANCE_BOUNDED_H_
#define ELASTIMATE_ESTIMATORS_FORCE_BALANCE_BOUNDED_H_

#include "elastimate/estimators/interface/estimator.h"

namespace elastimate {

/// The least force residual over the mean stiffness within bounds
/// (RegressForces).  For one isotropic material it is the bounded least squares
/// of Becker & Teschner 2007, eq. 24:
///
///   min ||a + nu b - t f||,  t = (1 + nu)(1 - 2 nu) / E,
///   nu_min <= nu <= nu_max,  E_min <= E <= E_max,
///
/// by Ceres on the few residuals that closed-form compresses the scene to.
/// Without bounds, nu is kept within its physical range.
///
/// Needs what closed-form needs.  Where a parameter lies on a bound, the
/// standard errors are those without it.  Noise still pulls nu up to its bound:
/// E is right when the bound is, and the estimate says when the difference
/// matters.
///
/// Cost: that of closed-form.  Single-threaded, deterministic.
class Bounded : public Estimator {
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

#endif  // ELASTIMATE_ESTIMATORS_FORCE_BALANCE_BOUNDED_H_
