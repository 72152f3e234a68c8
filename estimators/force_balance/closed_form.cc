#include "elastimate/estimators/force_balance/closed_form.h"

#include "elastimate/estimators/force_balance/force_residual.h"
#include "elastimate/estimators/force_balance/virtual_work_check.h"
#include "elastimate/estimators/interface/finding_sentences.h"

namespace elastimate {

std::string_view ClosedForm::Name() const { return "closed-form"; }

std::string_view ClosedForm::Description() const {
  return "linear least squares of the force residual, one pass over the "
         "elements; exact without noise, biased with it [Becker & Teschner "
         "2007, eq. 20-23]";
}

std::string ClosedForm::WhyUnsupported(const Scene& scene,
                                       const EstimatorOptions& options) const {
  if (options.poisson_ratio.AreGiven() || options.youngs_modulus.AreGiven()) {
    return "it cannot keep bounds; use bounded or reduced-fe";
  }
  if (options.loss != Loss::kNone) {
    return "a loss function needs displacement residuals; use reduced-fe";
  }
  if (options.virtual_field_degree) {
    return "it has no virtual fields to take a degree; use virtual-fields";
  }
  return ForceResidual::WhyUnsupported(scene);
}

Estimate ClosedForm::DoRun(const Scene& scene,
                           const EstimatorOptions& options) const {
  const ForceResidual residual(scene);
  Estimate estimate;
  estimate.Accept();
  estimate.work = residual.WorkDone();
  const bool free_poisson_ratio = !options.known_poisson_ratio;
  const std::optional<double> nu = free_poisson_ratio
                                       ? residual.PoissonRatio()
                                       : options.known_poisson_ratio;
  if (!nu) {
    estimate.Fail(residual.WhyNotIdentifiable());
    return estimate;
  }
  estimate.elasticity = residual.At(*nu);
  residual.Describe(true, free_poisson_ratio, estimate);
  if (!estimate.elasticity.IsPhysical()) {
    estimate.Fail(!(*nu > -1 && *nu < 0.5)
                      ? UnphysicalByNoise(estimate.elasticity)
                      : DisplacementsOpposeLoads());
  } else if (free_poisson_ratio) {
    JudgeNoiseBias(residual, Bounds{}, estimate);
  } else {
    JudgeKnownPoissonRatio(residual, estimate);
  }
  CheckByVirtualWork(scene, options, estimate);
  return estimate;
}

}  // namespace elastimate
