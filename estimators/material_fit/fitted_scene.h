#ifndef ELASTIMATE_ESTIMATORS_MATERIAL_FIT_FITTED_SCENE_H_
#define ELASTIMATE_ESTIMATORS_MATERIAL_FIT_FITTED_SCENE_H_

#include <optional>

#include "elastimate/core/scene/scene.h"
#include "elastimate/estimators/interface/estimate.h"

namespace elastimate {

/// Returns the scene as an estimate has fitted it, where that differs from
/// `scene`: with the law of large strains that took the place of the isotropic
/// one (Estimate::large_strain_law), and with quadratic elements on the mesh of
/// linear ones (Estimate::element_order).  The mesh is not divided.  Empty
/// where nothing differs.  O(num_elements).
[[nodiscard]] std::optional<Scene> FittedScene(const Scene& scene,
                                               const Estimate& estimate);

}  // namespace elastimate

#endif  // ELASTIMATE_ESTIMATORS_MATERIAL_FIT_FITTED_SCENE_H_
