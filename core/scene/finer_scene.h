#ifndef ELASTIMATE_CORE_SCENE_FINER_SCENE_H_
#define ELASTIMATE_CORE_SCENE_FINER_SCENE_H_

#include "elastimate/core/scene/scene.h"

namespace elastimate {

/// Models a scene with finer elements, whatever its elements are: with the
/// quadratic elements (QuadraticScene) of its linear ones.  Quadratic elements
/// are first divided into linear ones of half the size (LinearScene).
///
/// Simplices of curved elements are parts of the curved body: the nodes in the
/// middle of their edges are where the map of the element that was cut has
/// them, and all loads do the same work as before on the displacements of the
/// elements.
///
/// Precondition: a valid scene (ValidateScene).  O(num_elements) time and
/// memory.
[[nodiscard]] Scene FinerScene(const Scene& scene);

}  // namespace elastimate

#endif  // ELASTIMATE_CORE_SCENE_FINER_SCENE_H_
