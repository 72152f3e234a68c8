#ifndef ELASTIMATE_CORE_SCENE_SIMPLICIAL_SCENE_H_
#define ELASTIMATE_CORE_SCENE_SIMPLICIAL_SCENE_H_

#include "elastimate/core/scene/scene.h"

namespace elastimate {

/// Models a scene with linear simplices of the same nodes (SimplicialMesh).
/// What is held, loaded or measured at nodes stays as it is; facets and points
/// become facets and points of the simplices.
///
/// Precondition: a valid scene (ValidateScene).  O(num_elements) time and
/// memory.
[[nodiscard]] Scene SimplicialScene(const Scene& scene);

}  // namespace elastimate

#endif  // ELASTIMATE_CORE_SCENE_SIMPLICIAL_SCENE_H_
