#ifndef ELASTIMATE_ORGAN_ORGAN_MESHER_H_
#define ELASTIMATE_ORGAN_ORGAN_MESHER_H_

#include "elastimate/core/mesh/mesh.h"

namespace elastimate {

/// OrganMesh (io/examples/organ_mesh.h) through the Gmsh library, whose state
/// is that of the process: for the program elastimate-organ.
Mesh MeshOrgan(int tetrahedra);

}  // namespace elastimate

#endif  // ELASTIMATE_ORGAN_ORGAN_MESHER_H_
