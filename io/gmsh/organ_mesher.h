#ifndef ELASTIMATE_IO_GMSH_ORGAN_MESHER_H_
#define ELASTIMATE_IO_GMSH_ORGAN_MESHER_H_

#include "elastimate/core/mesh/mesh.h"

namespace elastimate {

/// OrganMesh (io/examples/organ_mesh.h) through the Gmsh library, whose state
/// is that of the process: for the program elastimate-gmsh.
Mesh MeshOrgan(int tetrahedra);

}  // namespace elastimate

#endif  // ELASTIMATE_IO_GMSH_ORGAN_MESHER_H_
