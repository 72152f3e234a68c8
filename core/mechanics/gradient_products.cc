#include "elastimate/core/mechanics/gradient_products.h"

#include <vector>

#include "elastimate/core/mechanics/tet4_gradient_products.h"
#include "elastimate/core/mesh/shape_functions.h"
#include "elastimate/core/mesh/tet10.h"
#include "elastimate/core/mesh/tet4.h"

namespace elastimate {
namespace {

// The integrals of grad(N_i) grad(N_j)^T over one quadratic tetrahedron.  They
// are fixed combinations of P_ab = V g_a g_b^T, which follow from the means of
// lambda_a lambda_b, (1 + delta_ab) / 20.
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
  // Returns the mean of (4 lambda_a - 1)(4 lambda_b - 1), and of 4 lambda_a (4
  // lambda_b - 1).
  static double VertexWeight(int a, int b) { return a == b ? 0.6 : -0.2; }
  // Returns the mean of 16 lambda_a lambda_b.
  static double EdgeWeight(int a, int b) { return a == b ? 1.6 : 0.8; }

  Eigen::Matrix3d p_[4][4];
};

void AddQuadraticProducts(const Mesh& mesh, const NodeGraph& graph,
                          Eigen::Index first, Eigen::Index end,
                          Eigen::Index pair_mask, Eigen::MatrixXd& products) {
  for (Eigen::Index e = first; e < end; ++e) {
    const QuadraticElementProducts element(
        TetrahedronGradients(GatherTetrahedron(mesh, e)));
    const auto add = [&](int i, int j, const Eigen::Matrix3d& block) {
      const Eigen::Index pair =
          graph.element_pairs(NodeGraph::LocalPair(i, j), e) & pair_mask;
      auto product = products.block<3, 3>(0, 3 * pair);
      if (mesh.elements(i, e) >= mesh.elements(j, e)) {
        product += block;
      } else {
        product += block.transpose();
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

// Adds the products of elements of any kind, by its stiffness rule.
template <ElementKind kKind>
void AddProductsOfKind(const Mesh& mesh, const NodeGraph& graph,
                       Eigen::Index first, Eigen::Index end,
                       Eigen::Index pair_mask, Eigen::MatrixXd& products) {
  constexpr int kDimension = ElementSizes<kKind>::kDimension;
  constexpr int kNodes = ElementSizes<kKind>::kNodes;
  std::vector<ElementPoint<kKind>> points;
  for (Eigen::Index e = first; e < end; ++e) {
    points.clear();
    VisitPoints<kKind>(
        mesh, e, StiffnessRule<kKind>(),
        [&](const auto& point, const auto&) { points.push_back(point); });
    const int* const nodes = mesh.elements.col(e).data();
    for (int i = 0; i < kNodes; ++i) {
      for (int j = 0; j <= i; ++j) {
        const int row = nodes[i] >= nodes[j] ? i : j;
        const int column = i + j - row;
        const Eigen::Index pair =
            graph.element_pairs(NodeGraph::LocalPair(i, j), e) & pair_mask;
        auto product =
            products.block<kDimension, kDimension>(0, kDimension * pair);
        for (const ElementPoint<kKind>& point : points) {
          product.noalias() += (point.volume * point.gradient.col(row)) *
                               point.gradient.col(column).transpose();
        }
      }
    }
  }
}

}  // namespace

Eigen::MatrixXd GradientProducts(const Mesh& mesh, const NodeGraph& graph) {
  Eigen::MatrixXd products = Eigen::MatrixXd::Zero(
      ProductRows(mesh.Dimension()), mesh.Dimension() * graph.NumPairs());
  AddGradientProducts(mesh, graph, 0, mesh.NumElements(), kEveryPair, products);
  return products;
}

void AddGradientProducts(const Mesh& mesh, const NodeGraph& graph,
                         Eigen::Index first, Eigen::Index end,
                         Eigen::Index pair_mask, Eigen::MatrixXd& products) {
  VisitElementKind(mesh.kind, [&](auto kind) {
    if constexpr (kind == ElementKind::kTet4) {
      AddLinearGradientProducts(mesh, graph, first, end, pair_mask, products);
    } else if constexpr (kind == ElementKind::kTet10) {
      AddQuadraticProducts(mesh, graph, first, end, pair_mask, products);
    } else {
      AddProductsOfKind<kind>(mesh, graph, first, end, pair_mask, products);
    }
  });
}

}  // namespace elastimate
