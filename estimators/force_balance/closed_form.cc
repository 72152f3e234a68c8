#include "elastimate/estimators/force_balance/closed_form.h"

#include "elastimate/estimators/force_balance/force_regression.h"
#include "elastimate/estimators/force_balance/force_residual.h"
#include "elastimate/estimators/force_balance/virtual_work_check.h"
#include "elastimate/estimators/interface/judge.h"

namespace elastimate {

namespace {

Estimate RunClosedForm(const ForceResidual& residual, const Scene& scene,
                       const EstimatorOptions& options) {
  Estimate estimate;
  Evidence evidence;
  evidence.is_biased_by_noise = true;
  estimate.work = residual.WorkDone();
  const bool free_poisson_ratio = !options.known_poisson_ratio;
  const std::optional<double> nu = free_poisson_ratio
                                       ? residual.PoissonRatio()
                                       : options.known_poisson_ratio;
  if (!nu) {
    evidence.free_direction = residual.CollinearDirection();
    Judge(evidence, options, estimate);
    return estimate;
  }
  estimate.elasticity = residual.At(*nu);
  residual.Describe(true, free_poisson_ratio, evidence, estimate);
  if (free_poisson_ratio) {
    evidence.noise_bias = MeasureNoiseBias(residual, Bounds{}, estimate);
  } else {
    evidence.unbiased = MeasureUnbiasedPoissonRatio(residual, estimate);
  }
  Judge(evidence, options, estimate);
  evidence.work_check = CheckByVirtualWork(scene, options, estimate);
  Judge(evidence, options, estimate);
  return estimate;
}

}  // namespace

std::string_view ClosedForm::Name() const { return "closed-form"; }

std::string_view ClosedForm::Description() const {
  return "linear least squares of the force residual, one pass over the "
         "elements; exact without noise, biased with it [Becker & Teschner "
         "2007, eq. 20-23]";
}

Capabilities ClosedForm::WhatItTakes() const {
  Capabilities capabilities;
  capabilities.needs_all_displacements = true;
  capabilities.takes_materials = true;
  return capabilities;
}

Estimate ClosedForm::DoRun(const Scene& scene,
                           const EstimatorOptions& options) const {
  return IsOneIsotropicMaterial(scene.materials)
             ? RunClosedForm(ForceResidual(scene), scene, options)
             : RegressForces(scene, options, false);
}

std::unique_ptr<Preparation> ClosedForm::DoPrepare(
    const Scene& scene, const EstimatorOptions& options) const {
  if (!IsOneIsotropicMaterial(scene.materials)) {
    return Estimator::DoPrepare(scene, options);
  }
  return PrepareForceResidual(scene, options, RunClosedForm);
}

}  // namespace elastimate
