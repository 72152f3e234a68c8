#include "elastimate/estimators/material_fit/material_descent.h"

#include "elastimate/core/algebra/node_sums.h"
#include "elastimate/core/scene/observed_displacements.h"
#include "elastimate/estimators/force_balance/virtual_fields.h"
#include "elastimate/estimators/force_balance/virtual_work_regression.h"
#include "elastimate/estimators/interface/free_parameters.h"

namespace elastimate {
namespace {

// Whether displacements at x are nearer to the measured ones than none at all
// are.
bool ExplainsAnything(const Eigen::VectorXd& x, DisplacementMisfit& misfit) {
  Eigen::VectorXd residual;
  return misfit.Evaluate(x, &residual, nullptr) &&
         Norm(residual.head(misfit.Observed().Size())) < 1;
}

}  // namespace

std::optional<Eigen::VectorXd> TypicalStart(DisplacementMisfit& misfit) {
  const FreeParameters& free = misfit.Free();
  const std::optional<double> known = free.All().KnownModulus();
  const double scale = known.value_or(1);
  const std::optional<double> compliance =
      misfit.Compliance(free.All().Moduli(free.All().Typical(scale)));
  if (compliance) {
    return free.VariablesOf(free.All().Typical(scale / *compliance));
  }
  return known ? std::optional<Eigen::VectorXd>(
                     free.VariablesOf(free.All().Typical(*known)))
               : std::nullopt;
}

std::optional<Eigen::VectorXd> VirtualFieldsStart(
    const Scene& scene, const EstimatorOptions& options, Estimate& estimate) {
  // Near the minimum is near enough.
  constexpr int kIterations = 10;
  EstimatorOptions of_virtual_fields = options;
  of_virtual_fields.max_iterations = kIterations;
  of_virtual_fields.on_factorization = {};
  const VirtualFields virtual_fields;
  if (!virtual_fields.WhyUnsupported(scene, of_virtual_fields).empty()) {
    return std::nullopt;
  }
  const std::optional<BoundedMinimum> minimum =
      MinimizeVirtualWork(scene, of_virtual_fields, estimate.work);
  return minimum ? std::optional<Eigen::VectorXd>(minimum->variables)
                 : std::nullopt;
}

std::optional<BoundedMinimum> BestMinimum(const Scene& scene,
                                          const EstimatorOptions& options,
                                          DisplacementMisfit& misfit,
                                          Estimate& estimate) {
  std::optional<BoundedMinimum> best;
  for (const std::optional<Eigen::VectorXd>& start :
       {TypicalStart(misfit), VirtualFieldsStart(scene, options, estimate)}) {
    // A descent that begins beyond all data takes hundreds of steps, and ends
    // there.
    if (start && (!best || ExplainsAnything(*start, misfit))) {
      BoundedMinimum minimum =
          DescendFrom(options, *start, Distance::kFar, misfit);
      if (!best || minimum.cost < best->cost) {
        best = minimum;
      }
    }
  }
  return best;
}

}  // namespace elastimate
