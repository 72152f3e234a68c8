#include "elastimate/core/mesh/node_graph.h"

#include <algorithm>

#include "elastimate/core/mesh/elements_of_nodes.h"

namespace elastimate {

NodeGraph::NodeGraph(const Mesh& mesh)
    : start(mesh.NumNodes() + 1, 0),
      element_pairs(mesh.elements.rows() * (mesh.elements.rows() + 1) / 2,
                    mesh.NumElements()) {
  const Eigen::Index nodes_per_element = mesh.elements.rows();
  const ElementsOfNodes elements_of_nodes(mesh);
  // This holds the pair (node, j) while node j is at work; -1 when not a
  // neighbour.
  std::vector<int> pair_of_node(mesh.NumNodes(), -1);
  for (Eigen::Index j = 0; j < mesh.NumNodes(); ++j) {
    const auto first =
        elements_of_nodes.element.begin() + elements_of_nodes.start[j];
    const auto last =
        elements_of_nodes.element.begin() + elements_of_nodes.start[j + 1];
    start[j] = NumPairs();
    for (auto e = first; e != last; ++e) {
      for (const int node : mesh.elements.col(*e)) {
        if (node >= j && pair_of_node[node] < 0) {
          pair_of_node[node] = 0;
          row.push_back(node);
        }
      }
    }
    std::sort(row.begin() + start[j], row.end());
    for (Eigen::Index k = start[j]; k < NumPairs(); ++k) {
      pair_of_node[row[k]] = static_cast<int>(k);
    }
    for (auto e = first; e != last; ++e) {
      const auto nodes = mesh.elements.col(*e);
      const Eigen::Index local_j =
          std::find(nodes.begin(), nodes.end(), j) - nodes.begin();
      for (Eigen::Index i = 0; i < nodes_per_element; ++i) {
        if (nodes(i) >= j) {
          element_pairs(LocalPair(i, local_j), *e) = pair_of_node[nodes(i)];
        }
      }
    }
    for (Eigen::Index k = start[j]; k < NumPairs(); ++k) {
      pair_of_node[row[k]] = -1;
    }
  }
  start[mesh.NumNodes()] = NumPairs();
}

}  // namespace elastimate
