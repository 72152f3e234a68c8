#include "elastimate/estimators/material_fit/iterative_fe.h"

#include "elastimate/estimators/maps/map_fit.h"
#include "elastimate/estimators/material_fit/large_strain_choice.h"
#include "elastimate/estimators/material_fit/material_fit.h"

namespace elastimate {

std::string_view IterativeFe::Name() const { return "iterative-fe"; }

std::string_view IterativeFe::Description() const {
  return "maximum likelihood fit of the displacements with a finite element "
         "solution at each step; unbiased, but each step costs a "
         "factorisation; the reference for the others";
}

Capabilities IterativeFe::WhatItTakes() const {
  Capabilities capabilities;
  capabilities.needs_supports = true;
  capabilities.takes_bounds = true;
  capabilities.takes_losses = true;
  capabilities.takes_refinement = true;
  capabilities.takes_materials = true;
  capabilities.takes_free_axes = true;
  capabilities.takes_fields = true;
  capabilities.takes_large_strains = true;
  capabilities.compares_large_strain_laws = true;
  capabilities.takes_unknown_motion = true;
  capabilities.takes_supports_of_cases = true;
  return capabilities;
}

Estimate IterativeFe::DoRun(const Scene& scene,
                            const EstimatorOptions& options) const {
  if (HasFields(scene.materials)) {
    return FitMap(scene, options);
  }
  return options.kinematics == Kinematics::kLarge
             ? FitLargeStrainLaws(scene, options)
             : FitMaterials(scene, options, Descent::kFull);
}

std::unique_ptr<Preparation> IterativeFe::DoPrepare(
    const Scene& scene, const EstimatorOptions& options) const {
  return options.kinematics == Kinematics::kLarge || HasFields(scene.materials)
             ? Estimator::DoPrepare(scene, options)
             : PrepareMaterialFit(scene, options, Descent::kFull);
}

}  // namespace elastimate
