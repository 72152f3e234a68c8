#ifndef ELASTIMATE_CORE_SCENE_SPREAD_LOADS_H_
#define ELASTIMATE_CORE_SCENE_SPREAD_LOADS_H_

#include <vector>

#include "elastimate/core/mesh/mesh.h"
#include "elastimate/core/scene/scene.h"

namespace elastimate {

/// Loads of which other elements than these can be assembled: nodal forces that
/// are those of a force that is spread out are that force.
///
/// Where all vertices of facets of the surface are loaded, the nodal forces f
/// are those of a traction, t_i = f_i / A_i with the share A_i of node i in the
/// area of those facets, and on each facet the mean of its vertices, or of a
/// pressure, p_i = -f_i . a_i / |a_i|^2 with the share a_i in their area
/// vectors, whichever leaves less; where any node inside is loaded, or every
/// node that is not held, those of a body force in the elements whose vertices
/// are all loaded.  What the nodal forces of that leave of f is given to it
/// twice more in the same way, and the rest, if any, stays nodal forces, so
/// that the sum is f on these elements.  A uniform traction, pressure or body
/// force is found exactly; forces on nodes that are no neighbours stay as they
/// are, and so do other loads.
///
/// Precondition: linear elements; `held` is dimension x num_nodes. O(num_nodes
/// + num_elements) per load.
std::vector<Load> SpreadLoads(const Mesh& mesh, const ComponentMask& held,
                              const std::vector<Load>& loads);

}  // namespace elastimate

#endif  // ELASTIMATE_CORE_SCENE_SPREAD_LOADS_H_
