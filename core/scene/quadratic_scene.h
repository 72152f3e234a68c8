#ifndef ELASTIMATE_CORE_SCENE_QUADRATIC_SCENE_H_
#define ELASTIMATE_CORE_SCENE_QUADRATIC_SCENE_H_

#include <Eigen/Core>

#include "elastimate/core/mesh/mesh.h"
#include "elastimate/core/scene/scene.h"

namespace elastimate {

/// Models a scene with quadratic elements: each straight edge gets a node in
/// its middle and bends with the specimen (element order 2).  Quadrilaterals
/// and hexahedra get nodes in their own middle, too, and hexahedra in that of
/// each face.
///
/// The middle nodes come after those of `scene`, in the order of Middles, so
/// that the first columns of every array are those of `scene`.  At middle
/// nodes:
///
/// - Supports: a component is held where all vertices of the edge, face or
/// element hold it, at the mean of their displacements.  A middle in the
/// interior whose vertices are all on the surface is not held, since they may
/// belong to two supports with the specimen between them; but it is held if an
/// element of it is held at a node inside the specimen, because that is a held
/// volume.  Where supports are boxes, the boxes decide instead about each node
/// within.  Where a support may end within elements (FindSupportEnds),
/// Supports::in_doubt says so.
/// - Loads: nodal forces that stand for a distributed load become that load
/// (SpreadLoads).  Nodal forces that are left are zero on middle nodes, so that
/// their virtual work is that of the given forces on the displacements of the
/// vertices.  Body forces, tractions and pressures stay what they are; facets
/// get their middle nodes.
/// - Measurements: middle nodes are not observed, and their displacement is
/// zero.
///
/// Precondition: a valid scene (ValidateScene).  Throws std::invalid_argument
/// unless its elements are of order 1, and for a facet that is no face of the
/// mesh.  O(num_elements) time and memory.
///
///   const Scene quadratic = QuadraticScene(scene);
///   const Estimate estimate = MakeEstimator("iterative-fe")->Run(quadratic,
///                                                               {});
[[nodiscard]] Scene QuadraticScene(const Scene& scene);

}  // namespace elastimate

#endif  // ELASTIMATE_CORE_SCENE_QUADRATIC_SCENE_H_
