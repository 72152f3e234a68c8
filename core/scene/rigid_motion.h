#ifndef ELASTIMATE_CORE_SCENE_RIGID_MOTION_H_
#define ELASTIMATE_CORE_SCENE_RIGID_MOTION_H_

#include <string>

#include "elastimate/core/mesh/mesh.h"
#include "elastimate/core/scene/scene.h"

namespace elastimate {

/// Why the supports do not hold the specimen: a sentence that names a motion
/// without strain which they allow (a translation or a rotation of a part of
/// the mesh), or an empty string when there is none. A finite element solution
/// exists only when it is empty.
///
/// Tetrahedra that are connected through their faces move as a rigid body where
/// they have no strain; bodies that share only an edge or a node are hinged
/// there.
///
/// Precondition: a valid mesh.  O(num_elements log(num_elements)), and a sparse
/// factorisation with six unknowns for each hinged body.
std::string WhyNotHeld(const Mesh& mesh, const Supports& supports);

}  // namespace elastimate

#endif  // ELASTIMATE_CORE_SCENE_RIGID_MOTION_H_
