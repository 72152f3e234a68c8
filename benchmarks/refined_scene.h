#ifndef ELASTIMATE_BENCHMARKS_REFINED_SCENE_H_
#define ELASTIMATE_BENCHMARKS_REFINED_SCENE_H_

#include "elastimate/core/scene/scene.h"

namespace elastimate {

/// The same scene on a mesh of half the size: each tetrahedron is cut into
/// eight of equal volume, at the middle of its edges and along the shortest
/// diagonal inside, and each facet of a load into four.  The first nodes are
/// those of `scene`; supports and loads are those of QuadraticScene, whose
/// nodes these are.  Without measurements.
///
/// Precondition: a valid scene (ValidateScene).  Throws std::invalid_argument
/// unless its elements are linear tetrahedra.  O(num_elements).
Scene RefinedScene(const Scene& scene);

}  // namespace elastimate

#endif  // ELASTIMATE_BENCHMARKS_REFINED_SCENE_H_
