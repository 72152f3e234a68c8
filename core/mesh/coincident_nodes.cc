#include "elastimate/core/mesh/coincident_nodes.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <utility>

namespace elastimate {
namespace {

// Nodes that are closer than this share of the shortest edge are at the same
// place.  It is above the rounding of files in text or in single precision, and
// far below any gap that is meant.
constexpr double kSamePlace = 1e-4;

// Returns the shortest edge at each vertex, and for a node in the middle of
// vertices the shortest at one of these.
Eigen::VectorXd ShortestEdges(const Mesh& mesh) {
  Eigen::VectorXd squares = Eigen::VectorXd::Constant(
      mesh.NumNodes(), std::numeric_limits<double>::infinity());
  const ElementTopology& topology = mesh.Topology();
  for (Eigen::Index element = 0; element < mesh.NumElements(); ++element) {
    for (const auto& [i, k] : topology.edges) {
      const double square = (mesh.nodes.col(mesh.elements(i, element)) -
                             mesh.nodes.col(mesh.elements(k, element)))
                                .squaredNorm();
      double& of_i = squares(mesh.elements(i, element));
      double& of_k = squares(mesh.elements(k, element));
      of_i = std::min(of_i, square);
      of_k = std::min(of_k, square);
    }
  }
  for (const auto& nodes : mesh.elements.colwise()) {
    for (int i = topology.num_vertices; i < topology.num_nodes; ++i) {
      for (const int vertex : topology.middles[i - topology.num_vertices]) {
        squares(nodes(i)) = std::min(squares(nodes(i)), squares(nodes(vertex)));
      }
    }
  }
  return squares.cwiseSqrt();
}

}  // namespace

std::vector<std::array<int, 2>> CoincidentNodes(const Mesh& mesh) {
  const Eigen::VectorXd tolerance = kSamePlace * ShortestEdges(mesh);
  // The nodes are sorted along a direction in which the layers of a regular
  // mesh do not lie.
  const double along[3] = {std::sqrt(0.2), std::sqrt(0.3), std::sqrt(0.5)};
  const auto direction =
      Eigen::Map<const Eigen::RowVectorXd>(along, mesh.Dimension());
  const Eigen::VectorXd height = (direction * mesh.nodes).transpose();
  std::vector<int> order(mesh.NumNodes());
  std::iota(order.begin(), order.end(), 0);
  std::sort(order.begin(), order.end(), [&height](int a, int b) {
    return std::make_pair(height(a), a) < std::make_pair(height(b), b);
  });
  const auto partner = [&](std::ptrdiff_t position, std::ptrdiff_t step) {
    const int node = order[position];
    const auto size = static_cast<std::ptrdiff_t>(order.size());
    for (auto i = position + step; i >= 0 && i < size; i += step) {
      const int other = order[i];
      if (std::abs(height(other) - height(node)) > tolerance(node)) {
        break;
      }
      if ((mesh.nodes.col(other) - mesh.nodes.col(node)).norm() <=
          std::min(tolerance(node), tolerance(other))) {
        return other;
      }
    }
    return -1;
  };
  std::vector<std::array<int, 2>> coincident;
  for (std::ptrdiff_t i = 0; i < std::ptrdiff_t(order.size()); ++i) {
    const int after = partner(i, 1);
    const int other = after >= 0 ? after : partner(i, -1);
    if (other >= 0) {
      coincident.push_back({order[i], other});
    }
  }
  std::sort(coincident.begin(), coincident.end());
  return coincident;
}

}  // namespace elastimate
