#ifndef ELASTIMATE_ESTIMATORS_MATERIAL_FIT_ITERATIVE_FE_H_
#define ELASTIMATE_ESTIMATORS_MATERIAL_FIT_ITERATIVE_FE_H_

#include <memory>

#include "elastimate/estimators/interface/estimator.h"

namespace elastimate {

/// The reference: the maximum likelihood fit of any materials (FitMaterials)
/// with a factorisation of the stiffness at each step of Ceres, and analytic
/// derivatives du/dx = -K^-1 (dK/dx) u.
///
/// It takes what the other estimators do not: supports and rigid motions that
/// are unknown, load cells, and supports of each load case.
///
/// The sum of squares of one isotropic material can have several minima.  It is
/// taken at some nu over the whole range, with the E that fits best there; the
/// fit descends from every minimum among these and keeps the best.  A narrower
/// basin is missed, which only the certificate of reduced-fe rules out.
///
/// Cost: 5 to 8 factorisations from each start, and for one isotropic material
/// 8 more; memory is that of the factor.  Deterministic for a given number of
/// BLAS threads (Estimator::Run).
class IterativeFe : public Estimator {
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

#endif  // ELASTIMATE_ESTIMATORS_MATERIAL_FIT_ITERATIVE_FE_H_
