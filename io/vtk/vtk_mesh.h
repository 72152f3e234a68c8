#ifndef ELASTIMATE_IO_VTK_VTK_MESH_H_
#define ELASTIMATE_IO_VTK_VTK_MESH_H_

#include <filesystem>

#include "elastimate/io/mesh/mesh_file.h"

namespace elastimate {

/// Reads an unstructured grid from VTK's XML format, in any encoding.  Cells of
/// lower dimension than others are ignored; those left must be of one
/// ElementKind.  Throws std::invalid_argument, naming the file.
MeshFile ReadVtuMesh(const std::filesystem::path& path);

/// Reads an unstructured grid in the same way from VTK's legacy format, text or
/// binary.
MeshFile ReadLegacyVtkMesh(const std::filesystem::path& path);

}  // namespace elastimate

#endif  // ELASTIMATE_IO_VTK_VTK_MESH_H_
