#include "elastimate/io/scene/mesh_reader.h"

#include <set>
#include <string>

#include "elastimate/io/abaqus/abaqus_mesh.h"
#include "elastimate/io/febio/febio_mesh.h"
#include "elastimate/io/gmsh/gmsh_mesh.h"
#include "elastimate/io/mesh/mesh_file_check.h"
#include "elastimate/io/text/input_error.h"
#include "elastimate/io/text/input_file.h"
#include "elastimate/io/vtk/vtk_mesh.h"

namespace elastimate {

MeshFile ReadMeshFile(const std::filesystem::path& path) {
  CheckReadable(path);
  const std::string extension = FileExtension(path);
  MeshFile mesh;
  if (extension == ".vtu") {
    mesh = ReadVtuMesh(path);
  } else if (extension == ".vtk") {
    mesh = ReadLegacyVtkMesh(path);
  } else if (std::set<std::string>{".msh", ".mesh", ".unv", ".bdf"}.count(
                 extension) > 0) {
    mesh = ReadGmshMesh(path);
  } else if (extension == ".inp") {
    mesh = ReadAbaqusMesh(path);
  } else if (extension == ".feb") {
    mesh = ReadFebioMesh(path);
  } else {
    ThrowInputError(
        path,
        "the file name does not end in .vtu, .vtk, .msh, .mesh, "
        ".unv, .bdf, .inp or .feb (a mesh) or in .json (a scene); give a file "
        "of one of these formats");
  }
  mesh.path = path;
  CheckMeshFile(mesh);
  return mesh;
}

}  // namespace elastimate
