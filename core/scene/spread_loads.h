#ifndef ELASTIMATE_CORE_SCENE_SPREAD_LOADS_H_
#define ELASTIMATE_CORE_SCENE_SPREAD_LOADS_H_

#include <vector>

#include "elastimate/core/mesh/mesh.h"
#include "elastimate/core/scene/scene.h"

namespace elastimate {

/// Returns loads that can be assembled for other elements too: nodal forces
/// that stand for a force that is spread out become that force.
///
/// Where all vertices of some facets of the surface are loaded, the nodal
/// forces f become a traction or a pressure on those facets, whichever leaves
/// less.  The traction is t_i = f_i / A_i with the share A_i of node i in the
/// area of those facets, and the pressure is p_i = -f_i . a_i / |a_i|^2 with
/// its share a_i in their area vectors; on each facet it is the mean over the
/// vertices.  Where any node inside is loaded, or every node that is not held,
/// f becomes a body force in the elements whose vertices are all loaded.
///
/// The forces that this leaves of f are spread twice more in the same way, and
/// what then remains, if anything, stays nodal forces, so that the sum is f on
/// these elements.  A uniform traction, pressure or body force is found
/// exactly.  Forces on nodes that are no neighbours stay as they are, and so do
/// other loads.
///
/// Preconditions: linear elements; `surface` is BoundaryFacets of the mesh;
/// `held` is dimension x num_nodes.  O(num_nodes + num_elements) per load.
std::vector<Load> SpreadLoads(const Mesh& mesh, const Eigen::MatrixXi& surface,
                              const ComponentMask& held,
                              const std::vector<Load>& loads);

}  // namespace elastimate

#endif  // ELASTIMATE_CORE_SCENE_SPREAD_LOADS_H_
