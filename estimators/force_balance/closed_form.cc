#include "elastimate/estimators/force_balance/closed_form.h"

#include <sstream>

#include "elastimate/estimators/force_balance/force_residual.h"
#include "elastimate/estimators/force_balance/virtual_work_check.h"

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
  return capabilities;
}

Estimate ClosedForm::DoRun(const Scene& scene,
                           const EstimatorOptions& options) const {
  const ForceResidual residual(scene);
  Estimate estimate;
  estimate.status = Status::kOk;
  estimate.message = "";
  estimate.work = residual.WorkDone();
  const bool free_poisson_ratio = !options.known_poisson_ratio;
  const std::optional<double> nu = free_poisson_ratio
                                       ? residual.PoissonRatio()
                                       : options.known_poisson_ratio;
  if (!nu) {
    estimate.Fail(Status::kNotIdentifiable, residual.WhyNotIdentifiable(),
                  "the parameters are not determined");
    return estimate;
  }
  estimate.elasticity = residual.At(*nu);
  residual.Describe(true, free_poisson_ratio, estimate);
  if (!estimate.elasticity.IsPhysical()) {
    std::ostringstream text;
    text << "E = " << estimate.elasticity.youngs_modulus << ", nu = " << *nu
         << " is not physical: "
         << (!(*nu > -1 && *nu < 0.5)
                 ? "displacement noise pulls nu of this method towards 2/3 and "
                   "E below zero, and so may a mesh, supports or loads that do "
                   "not describe the experiment; use reduced-fe, which noise "
                   "does not bias, or give Poisson's ratio"
                 : kDisplacementsOpposeLoads);
    estimate.Fail(Status::kUnphysical, text.str(),
                  "the estimate is not physical");
  } else if (free_poisson_ratio) {
    JudgeNoiseBias(residual, Bounds{}, estimate);
  } else {
    JudgeKnownPoissonRatio(residual, estimate);
  }
  CheckByVirtualWork(scene, options, estimate);
  return estimate;
}

}  // namespace elastimate
