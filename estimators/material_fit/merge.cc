#include "elastimate/estimators/material_fit/merge.h"

#include <algorithm>
#include <cstddef>
#include <optional>

#include "elastimate/core/scene/observed_displacements.h"
#include "elastimate/estimators/material_fit/material_fit.h"
#include "elastimate/estimators/material_fit/merge_plan.h"
#include "elastimate/estimators/material_fit/outliers.h"

namespace elastimate {
namespace {

std::vector<int> RegionsOf(const std::vector<Material>& materials,
                           const std::vector<std::size_t>& group) {
  std::vector<int> regions;
  for (const std::size_t member : group) {
    regions.insert(regions.end(), materials[member].regions.begin(),
                   materials[member].regions.end());
  }
  std::sort(regions.begin(), regions.end());
  return regions;
}

// The limits of the first steps.
double LimitOf(const MergePlan& plan, std::size_t num_steps) {
  double limit = 0;
  for (std::size_t i = 0; i < num_steps; ++i) {
    limit += plan.path[i].limit;
  }
  return limit;
}

// Whether a fit after these steps of a plan is as good as it said.
bool HoldsWhatWasPlanned(const MergePlan& plan, std::size_t num_steps,
                         const MaterialParameters& parameters,
                         const MaterialFit& apart, const MaterialFit& merged) {
  if (!merged.variables || !(merged.errors.square_sum > 0)) {
    return false;
  }
  const double chi_square =
      (merged.errors.square_sum - apart.errors.square_sum) /
      apart.errors.variance;
  const double planned =
      ChiSquareOfGroups(plan.path[num_steps - 1].groups, parameters,
                        {*apart.variables, apart.errors.of_noise});
  return chi_square <= planned + LimitOf(plan, num_steps);
}

}  // namespace

MaterialMerge MergeMaterials(const Scene& scene,
                             const EstimatorOptions& options) {
  MaterialMerge merge = {scene.materials, {}, {}, {}};
  const MaterialFit apart = FitMaterialsFrom(std::nullopt, scene, options);
  merge.work = apart.estimate.work;
  if (!apart.variables || !apart.errors.total.allFinite() ||
      !(apart.errors.variance > 0) ||
      apart.errors.total.cols() != apart.variables->size()) {
    merge.why_not = apart.estimate.message.empty()
                        ? "there is no noise to tell materials apart by"
                        : apart.estimate.message;
    return merge;
  }
  const MaterialParameters parameters(scene.materials,
                                      scene.mesh.section.model);
  const MergePlan plan = PlanMerges(
      scene.materials, parameters, {apart.errors.corrected, apart.errors.total},
      static_cast<double>(ObservedDisplacements(scene).Size()));
  Scene merged = WithoutOutliers(scene, apart.estimate.outliers);
  std::size_t num_taken = plan.num_taken;
  for (; num_taken > 0; --num_taken) {
    const PlannedMerge& last = plan.path[num_taken - 1];
    merged.materials = MaterialsOfGroups(scene.materials, last.groups);
    const MaterialFit fit = FitMaterialsFrom(last.variables, merged, options);
    merge.work = merge.work + fit.estimate.work;
    if (HoldsWhatWasPlanned(plan, num_taken, parameters, apart, fit)) {
      merge.materials = merged.materials;
      break;
    }
  }
  for (std::size_t i = 0; i < plan.path.size(); ++i) {
    const PlannedMerge& step = plan.path[i];
    merge.path.push_back({RegionsOf(scene.materials, step.first),
                          RegionsOf(scene.materials, step.second),
                          step.chi_square, step.limit, i < num_taken});
  }
  return merge;
}

}  // namespace elastimate
