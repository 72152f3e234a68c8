#ifndef ELASTIMATE_IO_EXAMPLES_ORGAN_MESH_H_
#define ELASTIMATE_IO_EXAMPLES_ORGAN_MESH_H_

#include "elastimate/core/mesh/mesh.h"

namespace elastimate {

/// A tetrahedral mesh of the organ by the Gmsh library, of uniform size, with
/// the wanted number of tetrahedra within 5 %.  The nodes of its surface are
/// points of the organ's surface, up to rounding; two of them are at
/// x = -1/2 and x = 1/2.  The nodes are numbered as Gmsh left them.
///
/// Up to 100 000 tetrahedra, a mesh with a dihedral angle below 15 degrees is
/// made again with slightly different edges, seven times at most; beyond, the
/// first is taken.  Quality and cost are stated at OrganScene.  One thread; the
/// same mesh on every run.
///
/// Throws std::runtime_error, naming the step, when Gmsh fails, and when no
/// mesh size gives the wanted number.  Gmsh runs in a process of its own.
Mesh OrganMesh(int tetrahedra);

}  // namespace elastimate

#endif  // ELASTIMATE_IO_EXAMPLES_ORGAN_MESH_H_
