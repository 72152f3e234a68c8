#ifndef ELASTIMATE_BENCHMARKS_MEASURED_BODY_H_
#define ELASTIMATE_BENCHMARKS_MEASURED_BODY_H_

#include "elastimate/core/laws/elasticity.h"
#include "elastimate/core/scene/scene.h"

namespace elastimate {

/// A unit cube of `cells` cells along each edge, of five tetrahedra each, with
/// the displacement
///
///   u = 1e-4 z (2 x + z, y - 2 x z, -5 - 3 x y)
///
/// at its nodes, and the nodal forces f = K u that cause it: an exact
/// measurement for which nothing has to be factorised.
Scene MeasuredCube(int cells, const IsotropicElasticity& elasticity);

/// The organ of OrganScene, an unstructured mesh, scaled to be as long as the
/// cube.  It is held at all nodes in the lowest tenth of its height; u is that
/// of the cube with z counted from there.
Scene MeasuredOrgan(int tetrahedra, const IsotropicElasticity& elasticity);

}  // namespace elastimate

#endif  // ELASTIMATE_BENCHMARKS_MEASURED_BODY_H_
