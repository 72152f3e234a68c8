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
  MiddleNodesOfCells(const std::vector<QuadraticCell>& cells,
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

  int Find(const QuadraticCell& cell, int a, int b) {
    const auto found = middles_.find(EdgeOf(a, b));
    return found != middles_.end() ? found->second : Add(cell, a, b);
  }

  std::vector<AddedNode> TakeAdded() { return std::move(added_); }

 private:
  int Add(const QuadraticCell& cell, int a, int b) {
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
    const int node = int(positions_.cols()) + int(added_.size());
    added_.push_back(Between(a, b, around));
    middles_.emplace(EdgeOf(a, b), node);
    return node;
  }

  /// Returns the node between a and b, in the middle of some vertices.
  AddedNode Between(int a, int b, const std::vector<int>& vertices) const {
    // Positions of six digits err by less than this share of an edge.
    constexpr double kStraight = 1e-3;
    AddedNode added = {(positions_.col(a) + positions_.col(b)) / 2, vertices};
    Eigen::Vector3d sum = Eigen::Vector3d::Zero();
    bool is_straight = true;
    for (const int first : vertices) {
      for (const int second : vertices) {
        const auto found = middles_.find({first, second});
        if (found == middles_.end() || found->second >= positions_.cols()) {
          continue;
        }
        const Eigen::Vector3d x = positions_.col(first);
        const Eigen::Vector3d y = positions_.col(second);
        const Eigen::Vector3d middle = positions_.col(found->second);
        is_straight = is_straight && (middle - (x + y) / 2).norm() <=
                                         kStraight * (y - x).norm();
        sum += middle;
        added.around.push_back(found->second);
      }
    }
    if (!is_straight) {
      const auto num_vertices = double(vertices.size());
      const double num_middles = double(added.around.size()) - num_vertices;
      added.position = (1 + num_vertices / 4) / num_middles * sum -
                       positions_(Eigen::all, vertices).rowwise().sum() / 4;
    }
    return added;
  }

  const Eigen::Matrix3Xd& positions_;
  std::map<Edge, int> middles_;
  std::vector<AddedNode> added_;
};

}  // namespace

std::vector<AddedNode> AddMiddleNodes(const std::vector<QuadraticCell>& cells,
                                      const std::vector<std::size_t>& cell,
                                      const Eigen::Matrix3Xd& positions,
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
  return middles.TakeAdded();
}

}  // namespace elastimate
