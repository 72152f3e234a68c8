#ifndef ELASTIMATE_IO_MESH_SIMPLICES_H_
#define ELASTIMATE_IO_MESH_SIMPLICES_H_

#include <Eigen/Core>
#include <array>
#include <cstddef>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace elastimate {

/// The shape of a cell of a mesh, whose vertices are in the order of VTK.
struct CellShape {
  std::string_view name;    ///< "wedge".
  std::string_view plural;  ///< "wedges".
  int dimension;            ///< 2 or 3.
  int num_vertices;
  /// The vertices of each face (in two dimensions of each edge), all
  /// counter-clockwise or all clockwise seen from outside.
  std::vector<std::vector<int>> faces;
  /// The vertices at either end of each edge, in the order in which VTK has the
  /// nodes in their middles.
  std::vector<std::array<int, 2>> edges;
};

/// Returns the triangle, quadrilateral, tetrahedron, pyramid, wedge or
/// hexahedron that has so many vertices; null where there is none.
const CellShape* FindCellShape(int dimension, int num_vertices);

/// A cell of a file: its vertices and, behind them, no other nodes (it is
/// linear) or one in the middle of each edge (it is quadratic).
struct FileCell {
  const CellShape* shape;
  std::vector<int> nodes;
};

/// Simplices that cells of any shapes were cut into.
class Simplices {
 public:
  /// Their dimension is 2 or 3.
  explicit Simplices(int dimension) : dimension_(dimension) {}

  /// Adds the cell of these nodes.  Each simplex has the vertices of a triangle
  /// of a face (of an edge in two dimensions) and the least node of the cell,
  /// which is not in that face; the triangles of a face share its least node.
  /// Two cells thus cut a face that they share in the same way, whatever their
  /// shapes are [De Loera, Rambau & Santos, Triangulations (2010), 4.3.2,
  /// "pulling"].  No simplex has a node twice, also if the cell has (collapsed
  /// edges).  Returns the number of simplices.
  std::size_t Add(const CellShape& shape, const std::vector<int>& nodes);

  /// dimension + 1 nodes x number of simplices, in the order of the cells.
  Eigen::MatrixXi Elements() const;
  /// The place of the cell of each simplex among those that were added.
  const std::vector<std::size_t>& Cells() const { return cells_; }
  /// Returns the first cell that folds onto itself, so that its simplices have
  /// volumes of both signs, or that has none.  `positions` are 3 x num_nodes.
  std::optional<std::size_t> FirstFolded(
      const Eigen::Matrix3Xd& positions) const;
  /// "3 hexahedra and 2 wedges (1 of them with collapsed edges) are read as 23
  /// tetrahedra with the same nodes".
  std::string Notice() const;

 private:
  int dimension_;
  std::vector<const CellShape*> shapes_;  ///< Of the cells.
  std::vector<char> are_collapsed_;       ///< Whether a cell has a node twice.
  std::vector<int> nodes_;
  std::vector<std::size_t> cells_;
};

/// Returns the triangles that a face of a cell is cut into, in the way of
/// Simplices; an edge as it is.  Those that have a node twice are left out.
template <typename Node>
std::vector<std::vector<Node>> CutFace(const std::vector<Node>& face);

}  // namespace elastimate

#endif  // ELASTIMATE_IO_MESH_SIMPLICES_H_
