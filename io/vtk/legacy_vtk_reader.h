#ifndef ELASTIMATE_IO_VTK_LEGACY_VTK_READER_H_
#define ELASTIMATE_IO_VTK_LEGACY_VTK_READER_H_

#include <filesystem>

#include "elastimate/io/mesh/mesh_file.h"

namespace elastimate {

/// Reads a legacy file through VTK, which may crash on a damaged one: for the
/// program elastimate-legacy-vtk.  Throws std::invalid_argument, naming the
/// file.
MeshFile ReadByLegacyVtk(const std::filesystem::path& path);

}  // namespace elastimate

#endif  // ELASTIMATE_IO_VTK_LEGACY_VTK_READER_H_
