#ifndef ELASTIMATE_IO_MESH_QUADRATIC_SIMPLICES_H_
#define ELASTIMATE_IO_MESH_QUADRATIC_SIMPLICES_H_

#include <Eigen/Core>
#include <cstddef>
#include <vector>

#include "elastimate/io/mesh/simplices.h"

namespace elastimate {

/// A cell that has a node in the middle of each edge behind its vertices, as
/// hexahedra of 20 nodes have.
struct QuadraticCell {
  const CellShape* shape;
  std::vector<int> nodes;
};

/// A node that no cell has.
struct AddedNode {
  Eigen::Vector3d position;
  /// All nodes of the side (or of the cell) that it is in the middle of.
  std::vector<int> around;
};

/// Appends rows with the nodes in the middle of the edges of `elements`, which
/// are the simplices of the vertices of `cells` (`cell` is the place of the
/// cell of each), in the order of VTK.  Returns the nodes that had to be added
/// for edges across a side or a cell, numbered from positions.cols() on.
///
/// An added node is in the middle of its edge where the edges of its side (of
/// its cell) are straight, else where the serendipity functions of the side (of
/// the cell) put its middle.  O(num_cells log num_cells).
std::vector<AddedNode> AddMiddleNodes(const std::vector<QuadraticCell>& cells,
                                      const std::vector<std::size_t>& cell,
                                      const Eigen::Matrix3Xd& positions,
                                      Eigen::MatrixXi& elements);

}  // namespace elastimate

#endif  // ELASTIMATE_IO_MESH_QUADRATIC_SIMPLICES_H_
