#ifndef ELASTIMATE_IO_VTK_VTK_CELLS_H_
#define ELASTIMATE_IO_VTK_VTK_CELLS_H_

#include <Eigen/Core>
#include <cstdint>
#include <string>
#include <vector>

#include "elastimate/io/mesh/mesh_file.h"

namespace elastimate {

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

}  // namespace elastimate

#endif  // ELASTIMATE_IO_VTK_VTK_CELLS_H_
