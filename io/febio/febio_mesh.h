#ifndef ELASTIMATE_IO_FEBIO_FEBIO_MESH_H_
#define ELASTIMATE_IO_FEBIO_FEBIO_MESH_H_

#include <filesystem>

#include "elastimate/io/mesh/mesh_file.h"

namespace elastimate {

/// Reads the mesh of a FEBio file (.feb) of version 3 or 4: nodes, elements,
/// node sets, element sets and surfaces.  The blocks of solid elements, which
/// have materials there, are its regions; shells and lines make up sets only.
///
/// Throws std::invalid_argument, naming the file and the part of it, for what
/// is wrong and for elements that are not for scenes (ToMeshFile).  O(size of
/// the file), with a factor of the logarithm.
MeshFile ReadFebioMesh(const std::filesystem::path& path);

}  // namespace elastimate

#endif  // ELASTIMATE_IO_FEBIO_FEBIO_MESH_H_
