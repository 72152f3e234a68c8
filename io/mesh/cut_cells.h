#ifndef ELASTIMATE_IO_MESH_CUT_CELLS_H_
#define ELASTIMATE_IO_MESH_CUT_CELLS_H_

#include <cstddef>
#include <functional>
#include <string>
#include <vector>

#include "elastimate/io/mesh/mesh_file.h"
#include "elastimate/io/mesh/simplices.h"

namespace elastimate {

/// Returns the beginning of a sentence about the cell at a place of a list,
/// such as "element 7 of type C3D20".
using CellNamer = std::function<std::string(std::size_t)>;

/// Makes the simplices that the cells are cut into (Simplices) the elements of
/// the mesh, whose nodes are those of the file, and adds a notice.  The cells
/// are of one dimension, and all are linear or all are quadratic.  Quadratic
/// ones get further nodes (AddMiddleNodes), with numbers behind the others.
/// Returns the place of the cell of each element.
///
/// Throws std::invalid_argument, naming the file and the cell, for one that is
/// folded or flat, and for one with a node that cannot be in the middle of its
/// edge.  O(num_cells log num_cells).
std::vector<std::size_t> CutCells(const std::vector<FileCell>& cells,
                                  const CellNamer& name, MeshFile& mesh);

/// Adds those added nodes that have all nodes around them among `nodes`, which
/// ascend.
void AddNodesBetween(const MeshFile& mesh, std::vector<int>& nodes);

}  // namespace elastimate

#endif  // ELASTIMATE_IO_MESH_CUT_CELLS_H_
