#ifndef ELASTIMATE_ESTIMATORS_DISPLACEMENT_FIT_REDUCED_FE_H_
#define ELASTIMATE_ESTIMATORS_DISPLACEMENT_FIT_REDUCED_FE_H_

#include <memory>

#include "elastimate/core/scene/scene.h"
#include "elastimate/estimators/interface/estimator.h"

namespace elastimate {

/// The maximum likelihood fit of iterative-fe without its iteration: the
/// displacements u = t w(nu) + v(nu) come from a ReducedModel, t = (1 + nu)(1 -
/// 2 nu) / E is eliminated in closed form [Golub & Pereyra 1973], and what is
/// left is a function of nu alone, searched over its whole range:
///
///   min over nu of min over t of sum over observed nodes of
///   loss(||t w(nu) + v(nu) - q||^2).
///
/// No initial guess; bounds are kept exactly.  The model is refined until it is
/// certified (AdaptiveFit) that its error at the estimate is below a tenth of
/// the noise, and that the full model leaves no less at any other nu that is
/// searched (from -0.95 to 0.49999, by multigrid to 0.495, or between the
/// bounds; further where the fit asks for it): the minimum is the global one.
/// Where rounding does not allow that, as in plates a thousand times wider than
/// thick, the status is iteration_limit.  A loss is minimised by iterative
/// reweighting from the least absolute deviations, with its scale from 1.4826
/// MAD of the residuals; the certificate is then that of the fit without a
/// loss, on whose model it is made.
///
/// Where the standard error of nu is large (kLargestLinearShare), the 95 %
/// interval of nu is that of the profile likelihood, and the standard errors of
/// nu and E are widened to it.
///
/// Needs supports that hold the specimen; any observed components will do.
/// Reaches the Cramer-Rao bound as long as the mesh describes the specimen.
///
/// Prepared (Estimator::Prepare), the factorisation and the reduced model are
/// kept: a further measurement, once the model has been refined where the
/// estimates lie, costs no solve and no element pass, O(num_nodes m) operations
/// for m = 10 to 30 basis vectors; with a loss O(num_nodes m^2) for each of
/// some 10 reweightings.  It agrees with Run within the tolerance of the
/// reduced model, a tenth of the standard error.
///
/// Cost: 2 factorisations (1 where bounds keep nu below 0.49; 3 or 4 near nu =
/// 1/2 or without noise), about 45 solves for each load case, of which ten
/// serve all; memory is that of the factor and about 80 vectors for each load
/// case.
///
/// Of several materials, the minimum is that of reduced models of all load
/// cases, where the gradient of the full model certifies it (ReducedMinimum):
/// 2 or 3 factorisations, and more where moduli differ by more than a factor of
/// ten from typical ones; not certified, the status is iteration_limit.
/// Outliers, covariance and what elements miss are those of FitMaterials.
/// Prepared, a fit starts where the last one ended.
/// Deterministic for a given number of BLAS threads (Estimator::Run).
class ReducedFe : public Estimator {
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

#endif  // ELASTIMATE_ESTIMATORS_DISPLACEMENT_FIT_REDUCED_FE_H_
