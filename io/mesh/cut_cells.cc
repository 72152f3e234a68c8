#include "elastimate/io/mesh/cut_cells.h"

#include <algorithm>
#include <cmath>

#include "elastimate/core/mesh/element_kind.h"
#include "elastimate/core/text/numbers.h"
#include "elastimate/io/mesh/quadratic_simplices.h"
#include "elastimate/io/text/input_error.h"

namespace elastimate {
namespace {

constexpr char kMend[] = "; order its nodes as its format does, or mesh again";

bool IsQuadratic(const FileCell& cell) {
  return int(cell.nodes.size()) > cell.shape->num_vertices;
}

/// Tells whether an edge that is a parabola may have this node in its middle:
/// the parabola does not turn back, and is hardly more bent than one around a
/// semicircle.  An edge without a length may have any.
bool MayBeInTheMiddle(const Eigen::Vector3d& from, const Eigen::Vector3d& to,
                      const Eigen::Vector3d& middle) {
  const Eigen::Vector3d edge = to - from;
  const Eigen::Vector3d off = middle - (from + to) / 2;
  const double along = off.dot(edge) / edge.squaredNorm();
  const double across = (off - along * edge).norm() / edge.norm();
  return edge.isZero(0) || (std::abs(along) < 0.25 && across < 0.6);
}

/// Throws for nodes in another order than that of edges.
void CheckMiddles(const std::vector<FileCell>& cells, const CellNamer& name,
                  const MeshFile& mesh) {
  for (std::size_t k = 0; k < cells.size(); ++k) {
    const auto& [shape, nodes] = cells[k];
    for (std::size_t i = 0; i < shape->edges.size(); ++i) {
      const int from = nodes[shape->edges[i][0]];
      const int to = nodes[shape->edges[i][1]];
      const int middle = nodes[std::size_t(shape->num_vertices) + i];
      if (from != to &&
          !MayBeInTheMiddle(mesh.nodes.col(from), mesh.nodes.col(to),
                            mesh.nodes.col(middle))) {
        ThrowInputError(mesh.path,
                        name(k) + " has " + NodeName(mesh, middle) +
                            " in the middle of its edge from " +
                            NodeName(mesh, from) + " to " + NodeName(mesh, to) +
                            ", but that node lies elsewhere" + kMend);
      }
    }
  }
}

}  // namespace

std::vector<std::size_t> CutCells(const std::vector<FileCell>& cells,
                                  const CellNamer& name, MeshFile& mesh) {
  const int dimension = cells.front().shape->dimension;
  mesh.is_cut = true;
  mesh.kind = dimension == 3 ? ElementKind::kTet4 : ElementKind::kTri3;
  Simplices simplices(dimension);
  for (const auto& [shape, nodes] : cells) {
    const auto first = nodes.begin();
    simplices.Add(*shape, {first, first + shape->num_vertices});
  }
  if (const auto folded = simplices.FirstFolded(mesh.nodes)) {
    ThrowInputError(mesh.path, name(*folded) + " is folded or flat" + kMend);
  }
  mesh.elements = simplices.Elements();
  std::string notice = simplices.Notice();
  if (IsQuadratic(cells.front())) {
    CheckMiddles(cells, name, mesh);
    mesh.kind = QuadraticKind(mesh.kind);
    mesh.added =
        AddMiddleNodes(cells, simplices.Cells(), mesh.nodes, mesh.elements);
    for (std::size_t i = 0; i < mesh.added.size() && !mesh.node_numbers.empty();
         ++i) {
      mesh.node_numbers.push_back(mesh.node_numbers.back() + 1);
    }
    notice += " and " + Counted(mesh.added.size(), "node") +
              " more, in the middle of new edges, which no measurement has";
  }
  mesh.notices.push_back(notice);
  return simplices.Cells();
}

void AddNodesBetween(const MeshFile& mesh, std::vector<int>& nodes) {
  const auto num_in_file = mesh.nodes.cols() - Eigen::Index(mesh.added.size());
  const std::vector<int> before = nodes;
  for (std::size_t i = 0; i < mesh.added.size(); ++i) {
    const std::vector<int>& around = mesh.added[i].around;
    if (std::all_of(around.begin(), around.end(), [&](int node) {
          return std::binary_search(before.begin(), before.end(), node);
        })) {
      nodes.push_back(int(num_in_file) + int(i));
    }
  }
}

}  // namespace elastimate
