#ifndef ELASTIMATE_CORE_SCENE_LINEAR_SCENE_H_
#define ELASTIMATE_CORE_SCENE_LINEAR_SCENE_H_

#include "elastimate/core/scene/scene.h"

namespace elastimate {

/// Models a scene with linear elements of the same nodes (LinearMesh).  What is
/// held or measured at nodes stays as it is; facets and points become facets
/// and points of the linear elements.  Nodal forces on linear elements become
/// loads that can be assembled for other elements too (SpreadLoads).
///
/// Precondition: a valid scene (ValidateScene).  O(num_elements) time and
/// memory.
[[nodiscard]] Scene LinearScene(const Scene& scene);

}  // namespace elastimate

#endif  // ELASTIMATE_CORE_SCENE_LINEAR_SCENE_H_
