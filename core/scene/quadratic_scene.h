#ifndef ELASTIMATE_CORE_SCENE_QUADRATIC_SCENE_H_
#define ELASTIMATE_CORE_SCENE_QUADRATIC_SCENE_H_

#include <Eigen/Core>

#include "elastimate/core/mesh/mesh.h"
#include "elastimate/core/scene/scene.h"

namespace elastimate {

/// Models a scene with quadratic simplices: each straight edge gets a node in
/// its middle and bends with the specimen (element order 2).
///
/// The mid-edge nodes come after those of `scene`, in ascending order of the
/// lower, then the higher end of their edge, so that the first columns of every
/// array are those of `scene`.  At mid-edge nodes:
///
/// - Supports: a component is held where both ends of the edge hold it, at the
/// mean of their displacements.  An edge that crosses the interior from one
/// node of the surface to another is not held, since its ends may belong to two
/// supports with the specimen between them; but it is held if an element of the
/// edge is held at a node inside the specimen, because that is a held volume.
/// Where supports are boxes, the boxes decide instead about each node within.
/// Where a support may end along an edge, Supports::in_doubt says so.
/// - Loads: nodal forces are zero there, so that their virtual work is that of
/// the given forces on the displacements of the vertices.  Body forces,
/// tractions and pressures stay what they are; facets get their mid-edge nodes.
/// - Measurements: mid-edge nodes are not observed, and their displacement is
/// zero.
///
/// Precondition: a valid scene (ValidateScene).  Throws std::invalid_argument
/// unless its elements are linear tetrahedra or triangles, and for a facet that
/// is no face of the mesh. O(num_elements) time and memory.
///
///   const Scene quadratic = QuadraticScene(scene);
///   const Estimate estimate = MakeEstimator("iterative-fe")->Run(quadratic,
///                                                               {});
[[nodiscard]] Scene QuadraticScene(const Scene& scene);

}  // namespace elastimate

#endif  // ELASTIMATE_CORE_SCENE_QUADRATIC_SCENE_H_
