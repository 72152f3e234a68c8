#ifndef ELASTIMATE_ESTIMATORS_MATERIAL_FIT_REDUCED_FE_H_
#define ELASTIMATE_ESTIMATORS_MATERIAL_FIT_REDUCED_FE_H_

#include <memory>

#include "elastimate/estimators/interface/estimator.h"

namespace elastimate {

/// The maximum likelihood fit of any materials (FitMaterials) with few
/// factorisations: displacements come from reduced models.
///
/// The minimum of one isotropic material is the global one, which is certified
/// over the whole range of nu (CertifiedDescent): 2 factorisations (1 where
/// bounds keep nu below 0.49; 3 or 4 near nu = 1/2 or without noise), and about
/// 45 solves for each load case, of which ten serve all; memory is that of the
/// factor and about 80 vectors for each load case.
///
/// The minimum of several materials is that of reduced models of all load
/// cases where the gradient of the full model confirms it (ReducedMinimum): 2
/// or 3 factorisations, and more where moduli differ by more than a factor of
/// ten from typical ones.
///
/// Where rounding leaves no certificate, as in plates a thousand times wider
/// than thick, the status is iteration_limit.
///
/// Needs supports that hold the specimen; any observed components will do.
/// Reaches the Cramer-Rao bound as long as the mesh describes the specimen.
/// Prepared (Estimator::Prepare), the reduced model of one isotropic material
/// is kept: a further measurement costs O(num_nodes m) operations for m = 10 to
/// 30 basis vectors, and no solve unless the model has to be refined.
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

#endif  // ELASTIMATE_ESTIMATORS_MATERIAL_FIT_REDUCED_FE_H_
