#include "elastimate/core/mesh/node_order.h"

#include <algorithm>
#include <cstdint>
#include <cstdlib>
#include <numeric>
#include <utility>

#include "elastimate/core/mesh/elements_of_nodes.h"

namespace elastimate {
namespace {

// Returns the nodes by their coordinate along the longest extent.  The search,
// and the search of each further connected part, begins with the first of them.
std::vector<int> NodesAlongLongestExtent(const Mesh& mesh) {
  const Eigen::VectorXd extent =
      mesh.nodes.rowwise().maxCoeff() - mesh.nodes.rowwise().minCoeff();
  Eigen::Index axis = 0;
  extent.maxCoeff(&axis);
  std::vector<int> nodes(mesh.NumNodes());
  std::iota(nodes.begin(), nodes.end(), 0);
  std::sort(nodes.begin(), nodes.end(), [&](int a, int b) {
    return std::pair(mesh.nodes(axis, a), a) <
           std::pair(mesh.nodes(axis, b), b);
  });
  return nodes;
}

}  // namespace

bool HasLocality(const Mesh& mesh) {
  constexpr Eigen::Index kNearNodes = 1024;
  constexpr Eigen::Index kFrontsInMesh = 16;
  const auto smallest_node = [&](Eigen::Index element) {
    return mesh.elements.col(element).minCoeff();
  };
  std::int64_t sum = 0;
  int previous = smallest_node(0);
  for (Eigen::Index element = 1; element < mesh.NumElements(); ++element) {
    const int next = smallest_node(element);
    sum += std::abs(next - previous);
    previous = next;
  }
  return sum / mesh.NumElements() <=
         std::max(kNearNodes, mesh.NumNodes() / kFrontsInMesh);
}

OrderedMesh OrderForLocality(const Mesh& mesh) {
  const ElementsOfNodes elements(mesh);
  std::vector<int> new_index(mesh.NumNodes(), -1);
  std::vector<bool> is_ordered(mesh.NumElements(), false);
  OrderedMesh ordered;
  ordered.mesh.kind = mesh.kind;
  ordered.mesh.section = mesh.section;
  ordered.places.reserve(mesh.NumNodes());
  ordered.element_places.reserve(mesh.NumElements());
  ordered.mesh.elements.resize(mesh.elements.rows(), mesh.NumElements());
  Eigen::Index num_elements = 0;
  const auto find = [&](int node) {
    if (new_index[node] < 0) {
      new_index[node] = static_cast<int>(ordered.places.size());
      ordered.places.push_back(node);
    }
    return new_index[node];
  };
  std::size_t next = 0;
  for (const int start : NodesAlongLongestExtent(mesh)) {
    find(start);
    for (; next < ordered.places.size(); ++next) {
      const int node = ordered.places[next];
      for (Eigen::Index k = elements.start[node]; k < elements.start[node + 1];
           ++k) {
        const Eigen::Index element = elements.element[k];
        if (is_ordered[element]) {
          continue;
        }
        is_ordered[element] = true;
        ordered.element_places.push_back(static_cast<int>(element));
        for (Eigen::Index i = 0; i < mesh.elements.rows(); ++i) {
          ordered.mesh.elements(i, num_elements) =
              find(mesh.elements(i, element));
        }
        ++num_elements;
      }
    }
  }
  ordered.mesh.nodes = mesh.nodes(Eigen::all, ordered.places);
  return ordered;
}

}  // namespace elastimate
