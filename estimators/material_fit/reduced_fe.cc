#include "elastimate/estimators/material_fit/reduced_fe.h"

#include "elastimate/estimators/material_fit/material_fit.h"

namespace elastimate {

std::string_view ReducedFe::Name() const { return "reduced-fe"; }

std::string_view ReducedFe::Description() const {
  return "maximum likelihood fit of the displacements by a reduced finite "
         "element model; unbiased, no initial guess, one or two "
         "factorisations";
}

Capabilities ReducedFe::WhatItTakes() const {
  Capabilities capabilities;
  capabilities.needs_supports = true;
  capabilities.takes_bounds = true;
  capabilities.takes_losses = true;
  capabilities.takes_refinement = true;
  capabilities.takes_materials = true;
  capabilities.takes_free_axes = true;
  return capabilities;
}

Estimate ReducedFe::DoRun(const Scene& scene,
                          const EstimatorOptions& options) const {
  return FitMaterials(scene, options, Descent::kReduced);
}

std::unique_ptr<Preparation> ReducedFe::DoPrepare(
    const Scene& scene, const EstimatorOptions& options) const {
  return PrepareMaterialFit(scene, options, Descent::kReduced);
}

}  // namespace elastimate
