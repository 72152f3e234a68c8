#include "elastimate/estimators/force_balance/bounded.h"

#include "elastimate/estimators/force_balance/force_regression.h"

namespace elastimate {

std::string_view Bounded::Name() const { return "bounded"; }

std::string_view Bounded::Description() const {
  return "closed-form with bounds on nu and E, solved by Ceres [Becker & "
         "Teschner "
         "2007, eq. 24]";
}

Capabilities Bounded::WhatItTakes() const {
  Capabilities capabilities;
  capabilities.needs_all_displacements = true;
  capabilities.takes_bounds = true;
  capabilities.takes_materials = true;
  capabilities.takes_large_strains = true;
  return capabilities;
}

Estimate Bounded::DoRun(const Scene& scene,
                        const EstimatorOptions& options) const {
  return RegressForces(scene, options, /*is_bounded=*/true);
}

std::unique_ptr<Preparation> Bounded::DoPrepare(
    const Scene& scene, const EstimatorOptions& options) const {
  return PrepareForceRegression(scene, options, /*is_bounded=*/true);
}

}  // namespace elastimate
