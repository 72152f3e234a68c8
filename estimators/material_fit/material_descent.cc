#include "elastimate/estimators/material_fit/material_descent.h"

#include <algorithm>
#include <vector>

#include "elastimate/core/algebra/node_sums.h"
#include "elastimate/core/materials/material.h"
#include "elastimate/core/scene/observed_displacements.h"
#include "elastimate/estimators/force_balance/virtual_fields.h"
#include "elastimate/estimators/force_balance/virtual_work_regression.h"
#include "elastimate/estimators/interface/free_parameters.h"
#include "elastimate/estimators/material_fit/certified_descent.h"

namespace elastimate {
namespace {

// Whether displacements at x are nearer to the measured ones than none at all
// are.
bool ExplainsAnything(const Eigen::VectorXd& x, DisplacementMisfit& misfit) {
  Eigen::VectorXd residual;
  return misfit.Evaluate(x, &residual, nullptr) &&
         Norm(residual.head(misfit.Observed().Size())) < 1;
}

// Where the misfit of one isotropic material is least among neighbours, of some
// nu that cover its range, each with the E that fits best there; none of other
// scenes, and where E is known.
std::vector<std::optional<Eigen::VectorXd>> StartsOverPoissonRatios(
    const Scene& scene, DisplacementMisfit& misfit) {
  std::vector<std::optional<Eigen::VectorXd>> starts;
  const FreeParameters& free = misfit.Free();
  if (!CertifiedDescent::Takes(scene) || free.Size() < 2) {
    return starts;
  }
  const Bounds& range = free.VariableBounds()[1];
  std::vector<Eigen::VectorXd> points;
  std::vector<double> square_sums;
  for (const double nu : {-0.85, -0.5, 0.0, 0.3, 0.45, 0.48, 0.495, 0.499}) {
    const double within = std::clamp(nu, *range.lower, *range.upper);
    double square_sum = 0;
    const std::optional<double> compliance = misfit.Compliance(
        free.All().Moduli(Eigen::Vector2d(1, within)), &square_sum);
    if (compliance && (points.empty() || points.back()(1) != within)) {
      points.push_back(
          free.VariablesOf(Eigen::Vector2d(1 / *compliance, within)));
      square_sums.push_back(square_sum);
    }
  }
  for (std::size_t i = 0; i < points.size(); ++i) {
    if (!(i > 0 && square_sums[i - 1] < square_sums[i]) &&
        !(i + 1 < points.size() && square_sums[i + 1] < square_sums[i])) {
      starts.emplace_back(points[i]);
    }
  }
  return starts;
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
    const Scene& scene, const EstimatorOptions& options,
    const FreeParameters& free, Estimate& estimate) {
  // Near the minimum is near enough.
  constexpr int kIterations = 10;
  EstimatorOptions of_virtual_fields = options;
  of_virtual_fields.max_iterations = kIterations;
  of_virtual_fields.on_factorization = {};
  const VirtualFields virtual_fields;
  if (!virtual_fields.WhyUnsupported(scene, of_virtual_fields).empty()) {
    return std::nullopt;
  }
  if (!IsOneIsotropicMaterial(scene.materials)) {
    const std::optional<BoundedMinimum> minimum =
        MinimizeVirtualWork(scene, of_virtual_fields, estimate.work);
    return minimum ? std::optional<Eigen::VectorXd>(minimum->variables)
                   : std::nullopt;
  }
  const Estimate start = virtual_fields.Run(scene, of_virtual_fields);
  estimate.work = estimate.work + start.work;
  Eigen::VectorXd parameters(Eigen::Index(start.parameters.size()));
  for (Eigen::Index i = 0; i < parameters.size(); ++i) {
    parameters(i) = start.parameters[i].value;
  }
  if (parameters.size() == 0) {
    return std::nullopt;
  }
  const Eigen::VectorXd variables = free.VariablesOf(parameters);
  return variables.allFinite() ? std::optional<Eigen::VectorXd>(variables)
                               : std::nullopt;
}

std::optional<BoundedMinimum> BestMinimum(const Scene& scene,
                                          const EstimatorOptions& options,
                                          DisplacementMisfit& misfit,
                                          Estimate& estimate) {
  std::vector<std::optional<Eigen::VectorXd>> starts =
      StartsOverPoissonRatios(scene, misfit);
  if (starts.empty()) {
    starts.push_back(TypicalStart(misfit));
  }
  starts.push_back(VirtualFieldsStart(scene, options, misfit.Free(), estimate));
  std::optional<BoundedMinimum> best;
  for (const std::optional<Eigen::VectorXd>& start : starts) {
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
