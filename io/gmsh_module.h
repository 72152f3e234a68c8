#ifndef ELASTIMATE_IO_GMSH_MODULE_H_
#define ELASTIMATE_IO_GMSH_MODULE_H_

#include <filesystem>

#include "elastimate/core/mesh.h"
#include "elastimate/io/mesh_file.h"

namespace elastimate {

/// What libelastimate_gmsh does.  It is loaded when it is used: Gmsh brings 90
/// libraries, which take ten times as long to load as all others.
struct GmshModule {
  /// Reads a file that is not damaged.  Throws std::invalid_argument, naming
  /// it.
  void (*read_mesh)(const std::filesystem::path& path, MeshFile& mesh);
  /// A mesh of the organ with edges of about `edge_length`.  Throws
  /// std::runtime_error, naming the step, when Gmsh fails.
  void (*mesh_organ)(double edge_length, Mesh& mesh);
};

/// Loads it at the first call.  Throws std::runtime_error when it is not found.
const GmshModule& LoadGmshModule();

}  // namespace elastimate

extern "C" {
__attribute__((visibility("default"))) void elastimate_read_gmsh_mesh(
    const std::filesystem::path& path, elastimate::MeshFile& mesh);
__attribute__((visibility("default"))) void elastimate_mesh_organ(
    double edge_length, elastimate::Mesh& mesh);
}

#endif  // ELASTIMATE_IO_GMSH_MODULE_H_
