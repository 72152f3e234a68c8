#include "elastimate/io/mesh/quadratic_simplices.h"

#include <algorithm>
#include <map>
#include <utility>

#include "elastimate/core/mesh/element_kind.h"

namespace elastimate {
namespace {

using Edge = std::pair<int, int>;

Edge EdgeOf(int a, int b) { return {std::min(a, b), std::max(a, b)}; }

class MiddleNodesOfCells {
 public:
  MiddleNodesOfCells(const std::vector<FileCell>& cells,
                     const Eigen::Matrix3Xd& positions)
      : positions_(positions) {
    for (const auto& [shape, nodes] : cells) {
      for (std::size_t i = 0; i < shape->edges.size(); ++i) {
        const auto [a, b] = shape->edges[i];
        middles_.emplace(EdgeOf(nodes[a], nodes[b]),
                         nodes[std::size_t(shape->num_vertices) + i]);
      }
    }
  }

  int Find(const FileCell& cell, int a, int b) {
    const auto found = middles_.find(EdgeOf(a, b));
    return found != middles_.end() ? found->second : Add(cell, a, b);
  }

  std::vector<AddedNode> TakeAdded() { return std::move(added_); }

  /// Returns the positions of the added nodes.
  Eigen::Matrix3Xd Positions() const {
    Eigen::Matrix3Xd positions(3, Eigen::Index(added_positions_.size()));
    for (std::size_t i = 0; i < added_positions_.size(); ++i) {
      positions.col(Eigen::Index(i)) = added_positions_[i];
    }
    return positions;
  }

 private:
  int Add(const FileCell& cell, int a, int b) {
    const auto vertices = cell.nodes.begin();
    std::vector<int> around(vertices, vertices + cell.shape->num_vertices);
    for (const std::vector<int>& places : cell.shape->faces) {
      std::vector<int> face;
      face.reserve(places.size());
      for (const int place : places) {
        face.push_back(cell.nodes[place]);
      }
      const auto has = [&face](int node) {
        return std::find(face.begin(), face.end(), node) != face.end();
      };
      if (has(a) && has(b)) {
        around = face;
      }
    }
    std::sort(around.begin(), around.end());
    around.erase(std::unique(around.begin(), around.end()), around.end());
    const int node = int(positions_.cols()) + int(added_.size());
    AddBetween(a, b, around);
    middles_.emplace(EdgeOf(a, b), node);
    return node;
  }

  /// Adds the node between a and b, in the middle of some vertices.
  void AddBetween(int a, int b, const std::vector<int>& vertices) {
    // Positions of six digits err by less than this share of an edge.
    constexpr double kStraight = 1e-3;
    AddedNode added = {vertices, {}};
    bool is_straight = true;
    for (const int first : vertices) {
      for (const int second : vertices) {
        const auto found = middles_.find({first, second});
        if (first == second || found == middles_.end() ||
            found->second >= positions_.cols()) {
          continue;
        }
        const Eigen::Vector3d x = positions_.col(first);
        const Eigen::Vector3d y = positions_.col(second);
        const Eigen::Vector3d middle = positions_.col(found->second);
        is_straight = is_straight && (middle - (x + y) / 2).norm() <=
                                         kStraight * (y - x).norm();
        added.around.push_back(found->second);
      }
    }
    const auto num_vertices = double(vertices.size());
    const double num_middles = double(added.around.size()) - num_vertices;
    added.weights.assign(vertices.size(), -0.25);
    added.weights.resize(added.around.size(),
                         (1 + num_vertices / 4) / num_middles);
    added_positions_.emplace_back(
        is_straight
            ? Eigen::Vector3d((positions_.col(a) + positions_.col(b)) / 2)
            : Eigen::Vector3d(ValuesAt(added, positions_)));
    added_.push_back(std::move(added));
  }

  const Eigen::Matrix3Xd& positions_;
  std::map<Edge, int> middles_;
  std::vector<AddedNode> added_;
  std::vector<Eigen::Vector3d> added_positions_;
};

}  // namespace

std::vector<AddedNode> AddMiddleNodes(const std::vector<FileCell>& cells,
                                      const std::vector<std::size_t>& cell,
                                      Eigen::Matrix3Xd& positions,
                                      Eigen::MatrixXi& elements) {
  const ElementTopology& topology = TopologyOf(
      elements.rows() == 4 ? ElementKind::kTet10 : ElementKind::kTri6);
  MiddleNodesOfCells middles(cells, positions);
  elements.conservativeResize(topology.num_nodes, Eigen::NoChange);
  for (Eigen::Index e = 0; e < elements.cols(); ++e) {
    auto nodes = elements.col(e);
    for (std::size_t i = 0; i < topology.middles.size(); ++i) {
      const std::vector<int>& ends = topology.middles[i];
      nodes(topology.num_vertices + Eigen::Index(i)) = middles.Find(
          cells[cell[std::size_t(e)]], nodes(ends[0]), nodes(ends[1]));
    }
  }
  const Eigen::Matrix3Xd added = middles.Positions();
  positions.conservativeResize(Eigen::NoChange,
                               positions.cols() + added.cols());
  positions.rightCols(added.cols()) = added;
  return middles.TakeAdded();
}

}  // namespace elastimate
