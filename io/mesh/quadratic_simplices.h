#ifndef ELASTIMATE_IO_MESH_QUADRATIC_SIMPLICES_H_
#define ELASTIMATE_IO_MESH_QUADRATIC_SIMPLICES_H_

#include <Eigen/Core>
#include <cstddef>
#include <vector>

#include "elastimate/io/mesh/mesh_file.h"
#include "elastimate/io/mesh/simplices.h"

namespace elastimate {

/// Appends rows with the nodes in the middle of the edges of `elements`, which
/// are the simplices of the vertices of `cells` (`cell` is the place of the
/// cell of each), in the order of VTK.  The cells have a node in the middle of
/// each edge behind their vertices, as hexahedra of 20 nodes have.  Returns the
/// nodes that had to be added for edges across a side or a cell, whose
/// positions are appended.
///
/// An added node is in the middle of its edge where the edges of its side (of
/// its cell) are straight, else where the serendipity functions of the side (of
/// the cell) put its middle.  O(num_cells log num_cells).
std::vector<AddedNode> AddMiddleNodes(const std::vector<FileCell>& cells,
                                      const std::vector<std::size_t>& cell,
                                      Eigen::Matrix3Xd& positions,
                                      Eigen::MatrixXi& elements);

}  // namespace elastimate

#endif  // ELASTIMATE_IO_MESH_QUADRATIC_SIMPLICES_H_
