#ifndef ELASTIMATE_ESTIMATORS_MATERIAL_FIT_MERGE_H_
#define ELASTIMATE_ESTIMATORS_MATERIAL_FIT_MERGE_H_

#include <string>
#include <vector>

#include "elastimate/core/scene/scene.h"
#include "elastimate/estimators/interface/estimate.h"
#include "elastimate/estimators/interface/estimator.h"
#include "elastimate/estimators/material_fit/merge_plan.h"

namespace elastimate {

/// The materials that a measurement tells apart.
struct MaterialMerge {
  std::vector<Material> materials;
  /// The steps that led there, and those that would have followed.
  std::vector<RegionMerge> path;
  /// How far the members of each material differ.
  std::vector<MemberSpread> spreads;
  /// The regions of the members of each of them.
  std::vector<std::vector<std::vector<int>>> members;
  /// The regions of materials that are not determined, and were not compared.
  std::vector<std::vector<int>> not_compared;
  /// Why nothing could be merged; empty where it was looked at.
  std::string why_not;
  Work work;
};

/// Merges materials of a scene as long as the measurement does not tell them
/// apart (MergePlan, from a fit of all of them, by errors of noise, of the
/// model and of the elements), and checks that by a fit of the merged ones: it
/// may be no farther from that of all apart than the steps were, or than their
/// limits, else a step less is taken.  A material is compared where all its
/// parameters are determined (Limits), be it by others that are one already.
/// Preconditions are those of FitMaterials; two materials at least.  Cost: that
/// of two FitMaterials, and one more for each step that is taken back.
MaterialMerge MergeMaterials(const Scene& scene,
                             const EstimatorOptions& options);

/// Enters what merging did into the estimate of the merged materials: the path,
/// how much members may differ, and a spread of members that their errors do
/// not explain into the errors, so that these are of each region.
void EnterMerge(const MaterialMerge& merge, Estimate& estimate);

}  // namespace elastimate

#endif  // ELASTIMATE_ESTIMATORS_MATERIAL_FIT_MERGE_H_
