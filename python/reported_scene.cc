#include "python/reported_scene.h"

#include "elastimate/core/scene/finer_scene.h"
#include "elastimate/estimators/material_fit/large_strain_choice.h"

namespace elastimate {

Scene ReportedScene(const Scene& scene, const Estimate& estimate) {
  Scene reported =
      estimate.element_order > scene.mesh.Order() ? FinerScene(scene) : scene;
  if (!estimate.large_strain_law.empty()) {
    reported.materials =
        MaterialsOfLargeStrains(reported.materials, estimate.large_strain_law);
  }
  return reported;
}

}  // namespace elastimate
