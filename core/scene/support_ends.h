#ifndef ELASTIMATE_CORE_SCENE_SUPPORT_ENDS_H_
#define ELASTIMATE_CORE_SCENE_SUPPORT_ENDS_H_

#include <cstddef>
#include <vector>

#include "elastimate/core/mesh/edges.h"
#include "elastimate/core/mesh/mesh.h"
#include "elastimate/core/scene/supports.h"

namespace elastimate {

/// Finds where the supports of a linear mesh end along its edges while nothing
/// says whether they hold the middle of the edge.  A component of an edge is
/// open in this sense if one end of the edge holds it, no box says where it
/// ends, `held` (dimension x num_edges) does not hold it, and
///
/// - the held end is a node of an element all of whose nodes are held, or next
/// to such a node: the support is a volume; or
/// - the edge is on the surface, in a facet that goes on without a crease from
/// one all of whose nodes are held: the support is a part of a surface.
///
/// A held node or line, and a face held up to its creases, leave nothing open.
/// Open edges with a common node belong to one end.  Their middles are ordered
/// along the axis, or else along Fisher's discriminant, that separates the held
/// nodes from the free ones; where neither separates them, they are one step.
///
/// The nodes of the result are those of QuadraticScene.  O(num_elements).
std::vector<SupportEnd> FindSupportEnds(const Supports& supports,
                                        const Mesh& mesh, const Edges& edges,
                                        const ComponentMask& held);

/// Returns the supports that hold so many steps of each end and leave no end
/// open.  Precondition: one number for each end, at most the number of its
/// steps.
Supports EndingAfter(const std::vector<std::size_t>& num_steps,
                     const Supports& supports);

}  // namespace elastimate

#endif  // ELASTIMATE_CORE_SCENE_SUPPORT_ENDS_H_
