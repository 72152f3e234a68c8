#ifndef ELASTIMATE_ESTIMATORS_DISPLACEMENT_FIT_ITERATIVE_FE_H_
#define ELASTIMATE_ESTIMATORS_DISPLACEMENT_FIT_ITERATIVE_FE_H_

#include <memory>

#include "elastimate/estimators/interface/estimator.h"

namespace elastimate {

/// The reference: maximum likelihood for independent Gaussian noise on the
/// displacements, by a finite element solution at each step,
///
///   min over (E, nu) of sum over observed nodes of loss(||u(E, nu) - q||^2),
///
/// with Ceres: one residual block for each observed node and load case, so
/// that a loss rejects a bad node as a whole; analytic derivatives
/// du/dtheta = -K^-1 (dK/dtheta) u; one factorisation for each nu tried,
/// shared by E and all load cases; bounds on E and nu.  The sum of squares can
/// have several minima: it and its slope are taken at nu = -0.85, -0.5, 0, 0.3,
/// 0.45, 0.48, 0.495, 0.499 and that of virtual-fields (moved into the bounds),
/// with the E that fits best there, and the fit descends into every basin that
/// these show and keeps the best.
/// Where the standard error of nu is large (kLargestLinearShare) or nu at the
/// end of its range, the interval of nu is that of the profile likelihood
/// between these starts, and the standard errors are widened to it.
///
/// Needs supports that hold the specimen; any observed components will do.
/// Reaches the Cramer-Rao bound as long as the mesh describes the specimen.
/// With a loss (scale 1.4826 MAD of the residuals, Huber k = 1.345, Cauchy
/// c = 2.385), the fit is repeated with the scale of a first one without.
///
/// Cost: 12 to 40 factorisations, the more the more basins show; memory is
/// that of the factor. Deterministic for a given number of BLAS threads
/// (Estimator::Run).
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

#endif  // ELASTIMATE_ESTIMATORS_DISPLACEMENT_FIT_ITERATIVE_FE_H_
