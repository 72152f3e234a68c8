#ifndef ELASTIMATE_IO_VTK_VTK_GRID_H_
#define ELASTIMATE_IO_VTK_VTK_GRID_H_

#include <filesystem>
#include <string>

#include "elastimate/io/mesh/mesh_file.h"
#include "elastimate/io/vtk/vtk_messages.h"

class vtkUnstructuredGrid;

namespace elastimate {

/// Returns the content of a grid that was read from `path`.  The elements are
/// the cells of dimension 3, or, where there is none, of dimension 2; others
/// are ignored.  Throws std::invalid_argument, naming the file, for elements
/// that are not all of one ElementKind, and for parts that do not agree.
MeshFile ToMeshFile(const std::filesystem::path& path,
                    vtkUnstructuredGrid* grid);

/// Throws std::invalid_argument: "FILE: the file is damaged or not a VTK file
/// of an unstructured grid (REASON); write it again".
[[noreturn]] void ThrowDamagedVtk(const std::filesystem::path& path,
                                  const std::string& reason);

/// Has one of VTK's readers read the file.  Throws std::invalid_argument,
/// naming the file, for whatever VTK complains of.
template <typename Reader>
void ReadByVtk(const std::filesystem::path& path, const VtkMessages& messages,
               Reader* reader) {
  reader->SetFileName(path.c_str());
  reader->Update();
  if (messages.HasError() || reader->GetErrorCode() != 0) {
    ThrowDamagedVtk(path, messages.HasError() ? messages.FirstError()
                                              : "VTK could not read it");
  }
}

}  // namespace elastimate

#endif  // ELASTIMATE_IO_VTK_VTK_GRID_H_
