#ifndef ELASTIMATE_IO_SCENE_MESH_READER_H_
#define ELASTIMATE_IO_SCENE_MESH_READER_H_

#include <filesystem>

#include "elastimate/io/mesh/mesh_file.h"

namespace elastimate {

/// Reads the files of kMeshExtensions; the extension may be in capital letters.
/// The mesh is as CheckMeshFile demands; arrays are as the file has them.
/// Throws as ReadScene does.
MeshFile ReadMeshFile(const std::filesystem::path& path);

}  // namespace elastimate

#endif  // ELASTIMATE_IO_SCENE_MESH_READER_H_
