#ifndef ELASTIMATE_IO_VTK_VTK_GRID_H_
#define ELASTIMATE_IO_VTK_VTK_GRID_H_

#include <Eigen/Core>
#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

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

/// Cells of another program, with their types and the order of their points as
/// in VTK.
struct VtkCells {
  Eigen::Matrix3Xd points;
  std::vector<unsigned char> types;
  /// The points of all cells, one cell after another.
  std::vector<std::int64_t> connectivity;
  /// Where the points of each cell begin in there, and the end of the last one.
  std::vector<std::int64_t> offsets;
};

/// Returns the mesh that a file of these cells holds, with the place of the
/// cell of each element in the element array `cell`.  `name` stands for the
/// file in the errors, which are those of a grid.
MeshFile ToMeshFile(const std::string& name, VtkCells cells);

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
