#include "benchmarks/voxel_mesh.h"

#include <array>
#include <vector>

#include "elastimate/core/mesh/element_kind.h"

namespace elastimate {
namespace {

// Corner i + 2 j + 4 k of a cell is its first corner plus (i, j, k).
using Corners = std::array<int, 8>;

// Kuhn's triangulation has a tetrahedron for each order of the axes, along
// which it goes from the first corner to the last.  So the cuts of neighbours
// match.
constexpr int kTetrahedra[6][4] = {{0, 1, 3, 7}, {0, 1, 5, 7}, {0, 2, 3, 7},
                                   {0, 2, 6, 7}, {0, 4, 5, 7}, {0, 4, 6, 7}};
// The corners of a hexahedron are in the order of VTK.
constexpr int kHexahedron[8] = {0, 1, 3, 2, 4, 5, 7, 6};

// The grid has `parts` cells along each axis in place of each cell of the body.
class Grid {
 public:
  Grid(const VoxelBody& body, int parts)
      : body_(body),
        parts_(parts),
        cells_(parts * body.cells),
        points_(cells_.array() + 1) {
    if (body.is_ring) {
      points_(0) = cells_(0);
    }
    FindCells();
    NumberNodes();
  }

  /// Returns the nodes at the corners of each cell of the body.
  const std::vector<Corners>& Cells() const { return corners_; }
  /// Returns the positions of the nodes, in units of the cells of the body.
  const Eigen::Matrix3Xd& Nodes() const { return nodes_; }

 private:
  int Index(const Eigen::Vector3i& point) const {
    return point(0) % points_(0) +
           points_(0) * (point(1) + points_(1) * point(2));
  }

  Eigen::Vector3i Point(int index) const {
    return {index % points_(0), index / points_(0) % points_(1),
            index / points_(0) / points_(1)};
  }

  Corners CornersOf(const Eigen::Vector3i& cell) const {
    Corners corners;
    for (int corner = 0; corner < 8; ++corner) {
      corners[corner] = Index(
          cell + Eigen::Vector3i(corner & 1, corner >> 1 & 1, corner >> 2 & 1));
    }
    return corners;
  }

  bool IsOfUndivided(int index) const {
    const Eigen::Vector3i point = Point(index);
    return (point.array() - parts_ * (point / parts_).array() == 0).all();
  }

  void FindCells();
  void NumberNodes();

  const VoxelBody& body_;
  int parts_;
  Eigen::Vector3i cells_;
  Eigen::Vector3i points_;
  std::vector<Corners> corners_;
  Eigen::Matrix3Xd nodes_;
};

void Grid::FindCells() {
  Eigen::Vector3i cell;
  for (cell(2) = 0; cell(2) < cells_(2); ++cell(2)) {
    for (cell(1) = 0; cell(1) < cells_(1); ++cell(1)) {
      for (cell(0) = 0; cell(0) < cells_(0); ++cell(0)) {
        if (body_.keeps((cell / parts_).cast<double>().array() + 0.5)) {
          corners_.push_back(CornersOf(cell));
        }
      }
    }
  }
}

// Numbers the points that are corners of cells.  The points of the undivided
// grid come first.
void Grid::NumberNodes() {
  constexpr int kUnused = -2;
  constexpr int kUsed = -1;
  std::vector<int> node(points_.prod(), kUnused);
  for (const Corners& corners : corners_) {
    for (const int point : corners) {
      node[point] = kUsed;
    }
  }
  std::vector<int> points;
  for (const bool of_undivided : {true, false}) {
    for (int point = 0; point < points_.prod(); ++point) {
      if (node[point] == kUsed && IsOfUndivided(point) == of_undivided) {
        node[point] = static_cast<int>(points.size());
        points.push_back(point);
      }
    }
  }
  nodes_.resize(3, Eigen::Index(points.size()));
  for (Eigen::Index i = 0; i < nodes_.cols(); ++i) {
    nodes_.col(i) = Point(points[i]).cast<double>() / parts_;
  }
  for (Corners& corners : corners_) {
    for (int& corner : corners) {
      corner = node[corner];
    }
  }
}

VoxelMesh WithoutElements(const VoxelBody& body, const Grid& grid,
                          ElementKind kind) {
  VoxelMesh voxels;
  voxels.mesh.kind = kind;
  voxels.grid = grid.Nodes();
  voxels.mesh.nodes.resize(3, voxels.grid.cols());
  for (Eigen::Index node = 0; node < voxels.grid.cols(); ++node) {
    voxels.mesh.nodes.col(node) = body.position(voxels.grid.col(node));
  }
  return voxels;
}

}  // namespace

VoxelMesh TetrahedralMesh(const VoxelBody& body) {
  const Grid grid(body, 1);
  VoxelMesh voxels = WithoutElements(body, grid, ElementKind::kTet4);
  voxels.mesh.elements.resize(4, 6 * Eigen::Index(grid.Cells().size()));
  Eigen::Index element = 0;
  for (const Corners& corners : grid.Cells()) {
    for (const auto& tetrahedron : kTetrahedra) {
      for (int i = 0; i < 4; ++i) {
        voxels.mesh.elements(i, element) = corners[tetrahedron[i]];
      }
      ++element;
    }
  }
  return voxels;
}

VoxelMesh HexahedralMesh(const VoxelBody& body, int parts) {
  const Grid grid(body, parts);
  VoxelMesh voxels = WithoutElements(body, grid, ElementKind::kHex8);
  voxels.mesh.elements.resize(8, Eigen::Index(grid.Cells().size()));
  Eigen::Index element = 0;
  for (const Corners& corners : grid.Cells()) {
    for (int i = 0; i < 8; ++i) {
      voxels.mesh.elements(i, element) = corners[kHexahedron[i]];
    }
    ++element;
  }
  return voxels;
}

}  // namespace elastimate
