#include "elastimate/io/scene/mesh_reader.h"

#include <set>
#include <string>

#include "elastimate/io/abaqus/abaqus_mesh.h"
#include "elastimate/io/febio/febio_mesh.h"
#include "elastimate/io/gmsh/gmsh_mesh.h"
#include "elastimate/io/mesh/mesh_file_check.h"
#include "elastimate/io/text/input_error.h"
#include "elastimate/io/text/input_file.h"
#include "elastimate/io/vtk/pvtu_mesh.h"
#include "elastimate/io/vtk/vtk_mesh.h"

namespace elastimate {
namespace {

/// Tells what to do with a file of another format.
std::string MendOfFormat(const std::filesystem::path& path,
                         const std::string& extension) {
  const std::set<std::string> of_meshio = {".med", ".xdmf", ".e",
                                           ".exo", ".ex2",  ".cgns"};
  const std::string file = PrintablePath(path.filename());
  if (of_meshio.count(extension) > 0) {
    return "convert it by: meshio convert " + file +
           " mesh.vtu (Debian package meshio-tools)";
  }
  if (extension == ".cdb") {
    return "convert it by: python3 -c \"from mapdl_archive import Archive; "
           "Archive('" +
           file + "').grid.save('mesh.vtu')\" (pip install mapdl-archive)";
  }
  return "give a file of one of these formats";
}

}  // namespace

MeshFile ReadMeshFile(const std::filesystem::path& path) {
  CheckReadable(path);
  const std::string extension = FileExtension(path);
  MeshFile mesh;
  if (extension == ".vtu") {
    mesh = ReadVtuMesh(path);
  } else if (extension == ".pvtu") {
    mesh = ReadPvtuMesh(path);
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
    ThrowInputError(path, "the file name does not end in " +
                              std::string(kMeshExtensions) +
                              " (a mesh) or in .json (a scene); " +
                              MendOfFormat(path, extension));
  }
  mesh.path = path;
  CheckMeshFile(mesh);
  return mesh;
}

}  // namespace elastimate
