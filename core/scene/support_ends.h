#ifndef ELASTIMATE_CORE_SCENE_SUPPORT_ENDS_H_
#define ELASTIMATE_CORE_SCENE_SUPPORT_ENDS_H_

#include <vector>

#include "elastimate/core/mesh/mesh.h"
#include "elastimate/core/mesh/middles.h"
#include "elastimate/core/scene/supports.h"

namespace elastimate {

/// Finds where the supports of a linear mesh end within its edges, faces and
/// elements while nothing says whether they hold the middle.  A component of a
/// middle is in doubt if some of its vertices hold it and some do
/// not, no box says where it ends, `held` (dimension x num_middles) does not
/// hold it, and
///
/// - a held vertex is a node of an element all of whose nodes are held, or next
/// to such a node: the support is a volume; or
/// - the middle is on the surface, in a facet that goes on without a crease
/// from one all of whose nodes are held: the support is a part of a surface.
///
/// A held node or line, and a face held up to its creases, leave nothing in
/// doubt.  The nodes of the result are those of QuadraticScene.
/// Precondition: `surface` is BoundaryFacets of the mesh.  O(num_elements).
std::vector<HeldComponent> FindSupportEnds(const Supports& supports,
                                           const Mesh& mesh,
                                           const Eigen::MatrixXi& surface,
                                           const Middles& middles,
                                           const ComponentMask& held);

}  // namespace elastimate

#endif  // ELASTIMATE_CORE_SCENE_SUPPORT_ENDS_H_
