#include "elastimate/core/node_graph.h"

#include <algorithm>

#include "elastimate/core/tetrahedron.h"

namespace elastimate {
namespace {

// The elements around each node: those of node n are
// element[start[n]] .. element[start[n + 1] - 1].
struct ElementsOfNodes {
  std::vector<Eigen::Index> start;
  std::vector<Eigen::Index> element;

  explicit ElementsOfNodes(const Mesh& mesh)
      : start(mesh.NumNodes() + 1, 0), element(mesh.elements.size()) {
    for (const int node : mesh.elements.reshaped()) {
      ++start[node + 1];
    }
    for (Eigen::Index node = 0; node < mesh.NumNodes(); ++node) {
      start[node + 1] += start[node];
    }
    std::vector<Eigen::Index> next(start.begin(), start.end() - 1);
    for (Eigen::Index e = 0; e < mesh.NumElements(); ++e) {
      for (const int node : mesh.elements.col(e)) {
        element[next[node]++] = e;
      }
    }
  }
};

}  // namespace

NodeGraph::NodeGraph(const Mesh& mesh)
    : start(mesh.NumNodes() + 1, 0),
      element_pairs(
          Eigen::MatrixXi::Constant(mesh.elements.rows() * mesh.elements.rows(),
                                    mesh.NumElements(), -1)) {
  const Eigen::Index nodes_per_element = mesh.elements.rows();
  const ElementsOfNodes elements_of_nodes(mesh);
  // The pair (node, j) while node j is at work; -1 when not a neighbour.
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
          element_pairs(i * nodes_per_element + local_j, *e) =
              pair_of_node[nodes(i)];
        }
      }
    }
    for (Eigen::Index k = start[j]; k < NumPairs(); ++k) {
      pair_of_node[row[k]] = -1;
    }
  }
  start[mesh.NumNodes()] = NumPairs();
}

Eigen::Matrix3Xd GradientProducts(const Mesh& mesh, const NodeGraph& graph) {
  Eigen::Matrix3Xd products = Eigen::Matrix3Xd::Zero(3, 3 * graph.NumPairs());
  for (Eigen::Index e = 0; e < mesh.NumElements(); ++e) {
    const TetrahedronGradients element(GatherTetrahedron(mesh, e));
    const Eigen::Matrix<double, 3, 4> weighted =
        element.volume * element.gradient;
    for (int i = 0; i < 4; ++i) {
      for (int j = 0; j < 4; ++j) {
        const int pair = graph.element_pairs(4 * i + j, e);
        if (pair >= 0) {
          products.middleCols<3>(3 * Eigen::Index(pair)).noalias() +=
              weighted.col(i) * element.gradient.col(j).transpose();
        }
      }
    }
  }
  return products;
}

}  // namespace elastimate
