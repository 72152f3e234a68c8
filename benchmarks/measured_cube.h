#ifndef ELASTIMATE_BENCHMARKS_MEASURED_CUBE_H_
#define ELASTIMATE_BENCHMARKS_MEASURED_CUBE_H_

#include "elastimate/core/laws/elasticity.h"
#include "elastimate/core/scene/scene.h"

namespace elastimate {

/// A unit cube of `cells` cells along each edge, of five tetrahedra each, with
/// the displacement
///
///   u = z (0.02 x + 0.01 z, 0.01 y - 0.02 x z, -0.05 - 0.03 x y)
///
/// at its nodes, and the nodal forces f = K u that cause it: an exact
/// measurement for which nothing has to be factorised.
Scene MeasuredCube(int cells, const IsotropicElasticity& elasticity);

}  // namespace elastimate

#endif  // ELASTIMATE_BENCHMARKS_MEASURED_CUBE_H_
