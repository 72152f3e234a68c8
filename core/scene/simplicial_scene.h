#ifndef ELASTIMATE_CORE_SCENE_SIMPLICIAL_SCENE_H_
#define ELASTIMATE_CORE_SCENE_SIMPLICIAL_SCENE_H_

#include "elastimate/core/scene/scene.h"

namespace elastimate {

/// Returns the scene modelled with linear simplices of the same nodes
/// (SimplicialMesh).  Supports, nodal forces and measurements of nodes stay
/// what they are; facets and points become those of the simplices.
///
/// Precondition: a valid scene (ValidateScene).  O(num_elements) time and
/// memory.
[[nodiscard]] Scene SimplicialScene(const Scene& scene);

}  // namespace elastimate

#endif  // ELASTIMATE_CORE_SCENE_SIMPLICIAL_SCENE_H_
