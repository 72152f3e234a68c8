#include "elastimate/estimators/force_balance/displacement_check.h"

#include <algorithm>
#include <cmath>
#include <memory>
#include <optional>

#include "elastimate/core/algebra/dense_algebra.h"
#include "elastimate/core/algebra/node_sums.h"
#include "elastimate/core/scene/rigid_motion.h"
#include "elastimate/estimators/force_balance/held_scene.h"
#include "elastimate/estimators/force_balance/work_balance.h"
#include "elastimate/estimators/interface/limits.h"
#include "elastimate/estimators/interface/parameter_judge.h"
#include "elastimate/estimators/misfit/curvature.h"
#include "elastimate/estimators/misfit/descent.h"
#include "elastimate/estimators/misfit/displacement_misfit.h"
#include "elastimate/estimators/misfit/finer_elements.h"
#include "elastimate/estimators/misfit/material_verdicts.h"
#include "elastimate/estimators/misfit/minimum_statistics.h"

namespace elastimate {
namespace {

// The minimum of the misfit near x, described; empty matrices where there is
// none.
MinimumErrors DescribeNearestMinimum(const Scene& scene,
                                     const EstimatorOptions& options,
                                     const Eigen::VectorXd& x,
                                     FinerElements* finer,
                                     DisplacementMisfit& misfit,
                                     Evidence& evidence, Estimate& estimate) {
  const std::optional<Eigen::VectorXd> linear = LinearMinimum(x, misfit);
  if (linear && IsNearlyQuadratic(misfit.Free(), x, *linear - x)) {
    return DescribeLinearMinimum(scene, x, *linear, finer, misfit, evidence,
                                 estimate);
  }
  const BoundedMinimum minimum =
      DescendFrom(options, x, Distance::kFar, misfit);
  evidence.end = minimum.end;
  evidence.search_message = minimum.message;
  return DescribeMinimum(scene, minimum.variables, finer, misfit, evidence,
                         estimate);
}

// What displacements of finer elements do to the balance.
struct ElementBias {
  Eigen::VectorXd residual;   ///< z that they leave.
  Eigen::VectorXd variables;  ///< b.
};

// Empty where nothing of their change is there, or not known.
std::optional<ElementBias> BiasOf(const Scene& scene, const VirtualWork& work,
                                  const FreeParameters& free,
                                  const MinimumErrors& errors,
                                  FinerElements& finer, Work& work_done) {
  const std::optional<Eigen::MatrixXd> displacement =
      errors.share_of_finer == 0 ? std::nullopt
                                 : finer.Displacement(errors.of_finer);
  if (!displacement) {
    return std::nullopt;
  }
  Scene specimen = scene;
  for (std::size_t k = 0; k < specimen.load_cases.size(); ++k) {
    specimen.load_cases[k].displacement =
        displacement->col(Eigen::Index(k))
            .head(scene.mesh.NumDofs())
            .reshaped(scene.mesh.Dimension(), scene.mesh.NumNodes());
  }
  WorkBalance balance(specimen, work);
  BalanceFit fit = {errors.of_finer, {}, {}};
  const bool has_fit = balance.Evaluate(free.ModuliAt(fit.variables),
                                        free.ModuliJacobian(fit.variables),
                                        &fit.residual, &fit.jacobian);
  work_done = work_done + balance.WorkDone();
  if (!has_fit) {
    return std::nullopt;
  }
  return ElementBias{
      fit.residual, -fit.Inverse() * (fit.jacobian.transpose() * fit.residual)};
}

// Enters x and its errors by their causes.
void EnterErrors(const Scene& scene, const BalanceFit& fit,
                 const std::optional<ElementBias>& bias,
                 const MinimumErrors& errors, double noise_variance,
                 const FreeParameters& free, Evidence& evidence,
                 Estimate& estimate) {
  const Eigen::MatrixXd inverse = fit.Inverse();
  BalanceFit corrected = fit;
  Eigen::MatrixXd of_change = Eigen::MatrixXd::Zero(free.Size(), free.Size());
  if (bias) {
    const double share = errors.share_of_finer;
    corrected.variables -= share * bias->variables;
    corrected.residual -=
        share * (bias->residual + fit.jacobian * bias->variables);
    of_change =
        errors.share_variance * bias->variables * bias->variables.transpose();
  } else if (errors.of_change.size() != 0) {
    of_change = errors.of_change;
  }
  const Eigen::MatrixXd of_noise = noise_variance * inverse;
  const Eigen::VectorXd d = errors.corrected - corrected.variables;
  Eigen::MatrixXd of_model = d * d.transpose() / kTwoSidedQuantile;
  if (corrected.Variance() >
      noise_variance *
          (1 + kLimits.significant_score * std::sqrt(2 / fit.Redundancy()))) {
    of_model += corrected.residual.squaredNorm() * inverse;
    estimate.is_model_in_doubt = true;
    evidence.virtual_work_error =
        std::sqrt((of_noise + of_model).diagonal().maxCoeff());
  }
  Eigen::MatrixXd of_minimum = errors.total - errors.of_noise;
  if (errors.of_change.size() != 0) {
    of_minimum -= errors.of_change;
  }
  const Eigen::VectorXd& x = corrected.variables;
  EnterParameters(scene, free, free.ParametersAt(x), estimate);
  ErrorBudget& budget = estimate.error_budget;
  budget.noise = ErrorsOfVariables(free, x, of_noise);
  budget.model = ErrorsOfVariables(free, x, of_model + of_minimum);
  budget.discretization = ErrorsOfVariables(free, x, of_change);
  EnterCovariance(free, x, of_noise + of_change + of_model + of_minimum,
                  estimate);
}

}  // namespace

double BalanceFit::Redundancy() const {
  return double(std::max<Eigen::Index>(residual.size() - variables.size(), 1));
}

Eigen::MatrixXd BalanceFit::Inverse() const {
  return elastimate::Inverse(jacobian.transpose() * jacobian);
}

void CheckByDisplacements(const Scene& scene, const EstimatorOptions& options,
                          const VirtualWork& work, const BalanceFit& fit,
                          const FreeParameters& free, Evidence& evidence,
                          Estimate& estimate) {
  const Scene held = HeldScene(scene);
  if (!WhyNotHeld(held).empty()) {
    evidence.end = End::kSingularStiffness;
    return;
  }
  DisplacementMisfit misfit(held, options);
  const std::unique_ptr<FinerElements> finer = FinerElements::Of(held, options);
  const MinimumErrors errors = DescribeNearestMinimum(
      held, options, fit.variables, finer.get(), misfit, evidence, estimate);
  evidence.solver_notice = misfit.Model().Notice();
  if (errors.total.size() != 0) {
    DescribeMaterials(held, errors, misfit, estimate);
    const std::optional<ElementBias> bias =
        finer ? BiasOf(scene, work, free, errors, *finer, estimate.work)
              : std::nullopt;
    EnterErrors(scene, fit, bias, errors,
                errors.variance * std::pow(misfit.Observed().Norm(), 2), free,
                evidence, estimate);
  }
  estimate.work = estimate.work + misfit.Model().WorkDone();
  if (finer) {
    estimate.work = estimate.work + finer->WorkDone();
  }
}

}  // namespace elastimate
