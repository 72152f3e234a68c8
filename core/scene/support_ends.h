#ifndef ELASTIMATE_CORE_SCENE_SUPPORT_ENDS_H_
#define ELASTIMATE_CORE_SCENE_SUPPORT_ENDS_H_

#include <cstddef>
#include <vector>

#include "elastimate/core/mesh/mesh.h"
#include "elastimate/core/mesh/middles.h"
#include "elastimate/core/scene/supports.h"

namespace elastimate {

/// Finds where the supports of a linear mesh end within its edges, faces and
/// elements while nothing says whether they hold the middle.  A component of a
/// middle is open in this sense if some of its vertices hold it and some do
/// not, no box says where it ends, `held` (dimension x num_middles) does not
/// hold it, and
///
/// - a held vertex is a node of an element all of whose nodes are held, or next
/// to such a node: the support is a volume; or
/// - the middle is on the surface, in a facet that goes on without a crease
/// from one all of whose nodes are held: the support is a part of a surface.
///
/// A held node or line, and a face held up to its creases, leave nothing open.
/// Open middles with a common vertex belong to one end.  They are ordered along
/// the axis, or else along Fisher's discriminant, that separates the held nodes
/// from the free ones; where neither separates them, they are one step.
///
/// The nodes of the result are those of QuadraticScene.  O(num_elements).
std::vector<SupportEnd> FindSupportEnds(const Supports& supports,
                                        const Mesh& mesh,
                                        const Middles& middles,
                                        const ComponentMask& held);

/// Returns the supports that hold so many steps of each end and leave no end
/// open.  Precondition: one number for each end, at most the number of its
/// steps.
Supports EndingAfter(const std::vector<std::size_t>& num_steps,
                     const Supports& supports);

}  // namespace elastimate

#endif  // ELASTIMATE_CORE_SCENE_SUPPORT_ENDS_H_
