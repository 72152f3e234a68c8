#ifndef ELASTIMATE_IO_GMSH_GMSH_MESH_H_
#define ELASTIMATE_IO_GMSH_GMSH_MESH_H_

#include <filesystem>

#include "elastimate/io/mesh/mesh_file.h"

namespace elastimate {

/// Reads .msh (versions 1, 2 and 4; with the node and element data in it),
/// .mesh, .unv and .bdf files through the Gmsh library.  Elements of lower
/// dimension than others only make up the physical groups; those left must be
/// of one ElementKind.  Their own physical groups are the element array
/// `region`, unless the file has one, or an element is in several of them
/// (MeshFile::why_no_regions).  Throws as ReadByProgram does.
///
/// Gmsh runs in the program elastimate-gmsh.  Beside what that does for the
/// safety of this process, it keeps Gmsh's 90 libraries out of it, which take
/// ten times as long to load as all others.
MeshFile ReadGmshMesh(const std::filesystem::path& path);

}  // namespace elastimate

#endif  // ELASTIMATE_IO_GMSH_GMSH_MESH_H_
