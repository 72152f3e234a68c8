#include "elastimate/estimators/material_fit/fitted_scene.h"

#include "elastimate/core/scene/finer_scene.h"
#include "elastimate/estimators/material_fit/large_strain_choice.h"

namespace elastimate {

std::optional<Scene> FittedScene(const Scene& scene, const Estimate& estimate) {
  const bool is_raised = estimate.element_order > scene.mesh.Order();
  if (!is_raised && estimate.large_strain_law.empty()) {
    return std::nullopt;
  }
  Scene fitted = is_raised ? FinerScene(scene) : scene;
  if (!estimate.large_strain_law.empty()) {
    fitted.materials =
        MaterialsOfLargeStrains(scene.materials, estimate.large_strain_law);
  }
  return fitted;
}

}  // namespace elastimate
