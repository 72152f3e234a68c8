#include "elastimate/estimators/force_balance/closed_form.h"

#include "elastimate/estimators/force_balance/force_regression.h"
#include "elastimate/estimators/force_balance/local_map_fit.h"

namespace elastimate {

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
  capabilities.takes_fields = true;
  capabilities.takes_large_strains = true;
  return capabilities;
}

Estimate ClosedForm::DoRun(const Scene& scene,
                           const EstimatorOptions& options) const {
  return HasFields(scene.materials)
             ? FitLocalMap(scene, options)
             : RegressForces(scene, options, /*is_bounded=*/false);
}

std::unique_ptr<Preparation> ClosedForm::DoPrepare(
    const Scene& scene, const EstimatorOptions& options) const {
  return HasFields(scene.materials)
             ? Estimator::DoPrepare(scene, options)
             : PrepareForceRegression(scene, options, /*is_bounded=*/false);
}

}  // namespace elastimate
