#include "elastimate/core/node_graph.h"

#include <algorithm>
#include <array>

#include "elastimate/core/elements_of_nodes.h"
#include "elastimate/core/quadratic_tetrahedron.h"
#include "elastimate/core/tetrahedron.h"

namespace elastimate {
namespace {

// The corners of an element by descending node index, so that the pair of any
// two in this order is one of the graph.  Without branches: the order is as
// good as random.
std::array<int, 4> CornersByDescendingNode(const int* nodes) {
  std::array<int, 4> corners = {0, 1, 2, 3};
  constexpr int kComparisons[5][2] = {{0, 1}, {2, 3}, {0, 2}, {1, 3}, {1, 2}};
  for (const auto& [i, j] : kComparisons) {
    const int first = corners[i];
    const int second = corners[j];
    const bool is_descending = nodes[first] > nodes[second];
    corners[i] = is_descending ? first : second;
    corners[j] = is_descending ? second : first;
  }
  return corners;
}

void AddLinearProducts(const Mesh& mesh, const NodeGraph& graph,
                       Eigen::Index first, Eigen::Index end,
                       Eigen::Index pair_mask, Eigen::Matrix3Xd& products) {
  for (Eigen::Index e = first; e < end; ++e) {
    const TetrahedronGradients element(GatherTetrahedron(mesh, e));
    const Eigen::Matrix<double, 3, 4> weighted =
        element.volume * element.gradient;
    const std::array<int, 4> corners =
        CornersByDescendingNode(mesh.elements.data() + 4 * e);
    const int* const pairs = graph.element_pairs.data() + 16 * e;
    for (int i = 0; i < 4; ++i) {
      const double* const row = weighted.data() + 3 * corners[i];
      for (int j = i; j < 4; ++j) {
        const double* const column = element.gradient.data() + 3 * corners[j];
        const double outer[9] = {
            row[0] * column[0], row[1] * column[0], row[2] * column[0],
            row[0] * column[1], row[1] * column[1], row[2] * column[1],
            row[0] * column[2], row[1] * column[2], row[2] * column[2]};
        const Eigen::Index pair = pairs[4 * corners[i] + corners[j]];
        double* const product = products.data() + 9 * (pair & pair_mask);
        for (int k = 0; k < 9; ++k) {
          product[k] += outer[k];
        }
      }
    }
  }
}

// The integrals of grad(N_i) grad(N_j)^T over one quadratic tetrahedron: fixed
// combinations of P_ab = V g_a g_b^T, from the means of lambda_a lambda_b,
// which are (1 + delta_ab) / 20.
class QuadraticElementProducts {
 public:
  explicit QuadraticElementProducts(const TetrahedronGradients& element) {
    for (int a = 0; a < 4; ++a) {
      for (int b = 0; b < 4; ++b) {
        p_[a][b].noalias() = (element.volume * element.gradient.col(a)) *
                             element.gradient.col(b).transpose();
      }
    }
  }

  Eigen::Matrix3d VertexVertex(int a, int b) const {
    return VertexWeight(a, b) * p_[a][b];
  }
  Eigen::Matrix3d EdgeVertex(const int (&edge)[2], int c) const {
    const auto [a, b] = edge;
    return VertexWeight(a, c) * p_[b][c] + VertexWeight(b, c) * p_[a][c];
  }
  Eigen::Matrix3d EdgeEdge(const int (&edge)[2], const int (&other)[2]) const {
    const auto [a, b] = edge;
    const auto [c, d] = other;
    return EdgeWeight(a, c) * p_[b][d] + EdgeWeight(a, d) * p_[b][c] +
           EdgeWeight(b, c) * p_[a][d] + EdgeWeight(b, d) * p_[a][c];
  }

 private:
  // Mean of (4 lambda_a - 1)(4 lambda_b - 1), and of 4 lambda_a (4 lambda_b -
  // 1).
  static double VertexWeight(int a, int b) { return a == b ? 0.6 : -0.2; }
  // Mean of 16 lambda_a lambda_b.
  static double EdgeWeight(int a, int b) { return a == b ? 1.6 : 0.8; }

  Eigen::Matrix3d p_[4][4];
};

void AddQuadraticProducts(const Mesh& mesh, const NodeGraph& graph,
                          Eigen::Index first, Eigen::Index end,
                          Eigen::Index pair_mask, Eigen::Matrix3Xd& products) {
  for (Eigen::Index e = first; e < end; ++e) {
    const QuadraticElementProducts element(
        TetrahedronGradients(GatherTetrahedron(mesh, e)));
    const auto add = [&](int i, int j, const Eigen::Matrix3d& block) {
      const int pair = graph.element_pairs(10 * i + j, e);
      if (pair >= 0) {
        products.middleCols<3>(3 * (pair & pair_mask)) += block;
      } else {
        const int transposed = graph.element_pairs(10 * j + i, e);
        products.middleCols<3>(3 * (transposed & pair_mask)) +=
            block.transpose();
      }
    };
    for (int i = 0; i < 4; ++i) {
      for (int j = 0; j <= i; ++j) {
        add(i, j, element.VertexVertex(i, j));
      }
    }
    for (int i = 0; i < 6; ++i) {
      for (int j = 0; j < 4; ++j) {
        add(4 + i, j, element.EdgeVertex(kTetrahedronEdges[i], j));
      }
      for (int j = 0; j <= i; ++j) {
        add(4 + i, 4 + j,
            element.EdgeEdge(kTetrahedronEdges[i], kTetrahedronEdges[j]));
      }
    }
  }
}

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
  AddGradientProducts(mesh, graph, 0, mesh.NumElements(), kEveryPair, products);
  return products;
}

void AddGradientProducts(const Mesh& mesh, const NodeGraph& graph,
                         Eigen::Index first, Eigen::Index end,
                         Eigen::Index pair_mask, Eigen::Matrix3Xd& products) {
  if (mesh.Order() == 1) {
    AddLinearProducts(mesh, graph, first, end, pair_mask, products);
  } else {
    AddQuadraticProducts(mesh, graph, first, end, pair_mask, products);
  }
}

}  // namespace elastimate
