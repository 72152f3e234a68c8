#ifndef ELASTIMATE_IO_GMSH_MESH_H_
#define ELASTIMATE_IO_GMSH_MESH_H_

#include <filesystem>

#include "elastimate/io/mesh_file.h"

namespace elastimate {

/// Reads .msh (versions 1, 2 and 4; with the node and element data in it),
/// .mesh, .unv and .bdf files through the Gmsh library.  Elements of lower
/// dimension only make up the physical groups; any other volume element but the
/// linear tetrahedron is an error.  Throws std::invalid_argument, naming the
/// file.  Starts and ends the Gmsh library, whose state belongs to the process:
/// not for a program that is using Gmsh, nor for two threads at once.
MeshFile ReadGmshMesh(const std::filesystem::path& path);

}  // namespace elastimate

#endif  // ELASTIMATE_IO_GMSH_MESH_H_
