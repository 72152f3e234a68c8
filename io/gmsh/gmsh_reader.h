#ifndef ELASTIMATE_IO_GMSH_GMSH_READER_H_
#define ELASTIMATE_IO_GMSH_GMSH_READER_H_

#include <filesystem>

#include "elastimate/io/mesh/mesh_file.h"

namespace elastimate {

/// Reads a file through the Gmsh library, for the program elastimate-gmsh: the
/// state of Gmsh is that of the process, and Gmsh may crash on a damaged file.
/// Opens the file as `link`, beside which Gmsh finds no other file to read, and
/// calls it `path`.  Throws std::invalid_argument, naming the file.
MeshFile ReadByGmsh(const std::filesystem::path& link,
                    const std::filesystem::path& path);

}  // namespace elastimate

#endif  // ELASTIMATE_IO_GMSH_GMSH_READER_H_
