#ifndef ELASTIMATE_CORE_SCENE_FINER_SCENE_H_
#define ELASTIMATE_CORE_SCENE_FINER_SCENE_H_

#include "elastimate/core/scene/scene.h"

namespace elastimate {

/// Returns the scene modelled with finer elements: for linear elements the
/// quadratic simplices (QuadraticScene) of what SimplicialScene cuts them into,
/// for quadratic elements of half the size.
/// Curved elements are cut into parts of the curved body: the nodes in the
/// middle of their edges are where the map of the element that was cut has
/// them, and all loads do the work on the displacements of the elements that
/// they did before.
///
/// Precondition: a valid scene (ValidateScene).  O(num_elements) time and
/// memory.
[[nodiscard]] Scene FinerScene(const Scene& scene);

}  // namespace elastimate

#endif  // ELASTIMATE_CORE_SCENE_FINER_SCENE_H_
