#ifndef ELASTIMATE_ORGAN_ORGAN_MESHER_H_
#define ELASTIMATE_ORGAN_ORGAN_MESHER_H_

#include "elastimate/core/mesh/mesh.h"

namespace elastimate {

/// Does what OrganMesh (io/examples/organ_mesh.h) does, through the Gmsh
/// library in this process, whose state is that of the process.  The program
/// elastimate-organ runs it.
Mesh MeshOrgan(int tetrahedra);

}  // namespace elastimate

#endif  // ELASTIMATE_ORGAN_ORGAN_MESHER_H_
