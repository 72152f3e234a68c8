#ifndef ELASTIMATE_CORE_SCENE_SUPPORT_ENDS_H_
#define ELASTIMATE_CORE_SCENE_SUPPORT_ENDS_H_

#include <vector>

#include "elastimate/core/mesh/edges.h"
#include "elastimate/core/mesh/mesh.h"
#include "elastimate/core/scene/supports.h"

namespace elastimate {

/// Finds where the supports of a linear mesh end along its edges while nothing
/// says whether they hold the middle of the edge.  A component of an edge is in
/// doubt if one end of the edge holds it, no box says where it ends, `held`
/// (dimension x num_edges) does not hold it, and
///
/// - the held end is a node of an element all of whose nodes are held, or next
/// to such a node: the support is a volume; or
/// - the edge is on the surface, in a facet that goes on without a crease from
/// one all of whose nodes are held: the support is a part of a surface.
///
/// A held node or line, and a face held up to its creases, leave nothing in
/// doubt.  The nodes of the result are those of QuadraticScene.
/// O(num_elements).
std::vector<HeldComponent> FindSupportEnds(const Supports& supports,
                                           const Mesh& mesh, const Edges& edges,
                                           const ComponentMask& held);

}  // namespace elastimate

#endif  // ELASTIMATE_CORE_SCENE_SUPPORT_ENDS_H_
