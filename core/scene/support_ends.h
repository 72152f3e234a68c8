#ifndef ELASTIMATE_CORE_SCENE_SUPPORT_ENDS_H_
#define ELASTIMATE_CORE_SCENE_SUPPORT_ENDS_H_

#include <cstddef>
#include <vector>

#include "elastimate/core/mesh/edges.h"
#include "elastimate/core/mesh/mesh.h"
#include "elastimate/core/scene/supports.h"

namespace elastimate {

/// Where the supports of a linear mesh end along its edges, and nothing says
/// whether they hold the middle.  That is open for the components of an edge
/// that one end holds, where no box says so and `held` (dimension x num_edges)
/// does not, and
///
/// - whose held end is a node of an element all of whose nodes are held, or
/// next
///   to one: the support is a volume; or
/// - which is on the surface, in a facet that goes on without a crease from one
///   all of whose nodes are held: the support is a part of a surface.
///
/// A held node or line, and a face held up to its creases, leave nothing open.
/// Edges with a common node are of one end.  Their middles are ordered along
/// the axis, or else along Fisher's discriminant, that separates the held nodes
/// from the free ones; where neither does, they are one step.
///
/// The nodes of the result are those of QuadraticScene.  O(num_elements).
std::vector<SupportEnd> FindSupportEnds(const Supports& supports,
                                        const Mesh& mesh, const Edges& edges,
                                        const ComponentMask& held);

/// The supports that hold so many steps of each end, which are open no more.
/// Precondition: as many as there are ends, none beyond the steps of its end.
Supports EndingAfter(const std::vector<std::size_t>& num_steps,
                     const Supports& supports);

}  // namespace elastimate

#endif  // ELASTIMATE_CORE_SCENE_SUPPORT_ENDS_H_
