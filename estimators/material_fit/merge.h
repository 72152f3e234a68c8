#ifndef ELASTIMATE_ESTIMATORS_MATERIAL_FIT_MERGE_H_
#define ELASTIMATE_ESTIMATORS_MATERIAL_FIT_MERGE_H_

#include <string>
#include <vector>

#include "elastimate/core/scene/scene.h"
#include "elastimate/estimators/interface/estimate.h"
#include "elastimate/estimators/interface/estimator.h"

namespace elastimate {

/// The materials that a measurement tells apart.
struct MaterialMerge {
  std::vector<Material> materials;
  /// The steps that led there, and those that would have followed.
  std::vector<RegionMerge> path;
  /// Why nothing could be merged; empty where it was looked at.
  std::string why_not;
  Work work;
};

/// Merges materials of a scene as long as the measurement does not tell them
/// apart (MergePlan, from a fit of all of them), and checks that by a fit of
/// the merged ones: its sum of squares may exceed that of all apart by no more
/// than the plan said and the criterion allows, else a step less is taken.
/// Preconditions are those of FitMaterials; two materials at least.  Cost: that
/// of two FitMaterials, and one more for each step that is taken back.
MaterialMerge MergeMaterials(const Scene& scene,
                             const EstimatorOptions& options);

}  // namespace elastimate

#endif  // ELASTIMATE_ESTIMATORS_MATERIAL_FIT_MERGE_H_
