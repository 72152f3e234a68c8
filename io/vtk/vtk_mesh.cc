#include "elastimate/io/vtk/vtk_mesh.h"

#include <vtkUnstructuredGrid.h>

#include "elastimate/io/helper/mesh_program_call.h"
#include "elastimate/io/vtk/vtk_grid.h"
#include "elastimate/io/vtk/vtu_grid.h"

namespace elastimate {

MeshFile ReadVtuMesh(const std::filesystem::path& path) {
  return ToMeshFile(path, ReadVtuGrid(path));
}

MeshFile ReadLegacyVtkMesh(const std::filesystem::path& path) {
  return ReadByProgram(
      {"elastimate-legacy-vtk", "VTK", "reads .vtk files", "write it again"},
      {}, path);
}

}  // namespace elastimate
