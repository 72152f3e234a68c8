#include "tests/quadratic_reference.h"

#include <Eigen/LU>
#include <algorithm>
#include <map>
#include <utility>

#include "tests/dense_reference.h"

namespace elastimate::testing {

Mesh WithMidEdgeNodes(const Mesh& mesh) {
  constexpr int kEnds[6][2] = {{0, 1}, {1, 2}, {0, 2}, {0, 3}, {1, 3}, {2, 3}};
  std::map<std::pair<int, int>, int> node_of_edge;
  Mesh quadratic;
  quadratic.regions = mesh.regions;
  quadratic.kind = ElementKind::kTet10;
  quadratic.elements.resize(10, mesh.NumElements());
  quadratic.elements.topRows<4>() = mesh.elements;
  for (Eigen::Index e = 0; e < mesh.NumElements(); ++e) {
    for (int i = 0; i < 6; ++i) {
      const std::pair<int, int> edge = std::minmax(
          {mesh.elements(kEnds[i][0], e), mesh.elements(kEnds[i][1], e)});
      const int next = static_cast<int>(mesh.NumNodes()) +
                       static_cast<int>(node_of_edge.size());
      quadratic.elements(4 + i, e) =
          node_of_edge.emplace(edge, next).first->second;
    }
  }
  quadratic.nodes.resize(
      3, mesh.NumNodes() + static_cast<Eigen::Index>(node_of_edge.size()));
  quadratic.nodes.leftCols(mesh.NumNodes()) = mesh.nodes;
  for (const auto& [edge, node] : node_of_edge) {
    quadratic.nodes.col(node) =
        (mesh.nodes.col(edge.first) + mesh.nodes.col(edge.second)) / 2;
  }
  return quadratic;
}

QuadraticShapeFunctions::QuadraticShapeFunctions(const Mesh& mesh,
                                                 Eigen::Index element) {
  Eigen::Matrix<double, 10, 10> at_nodes;
  for (int i = 0; i < 10; ++i) {
    nodes_.col(i) = mesh.nodes.col(mesh.elements(i, element));
  }
  // Close to the origin and of size 1, the monomials are independent.
  origin_ = nodes_.leftCols<4>().rowwise().mean();
  size_ = (nodes_.colwise() - origin_).colwise().norm().maxCoeff();
  for (int i = 0; i < 10; ++i) {
    at_nodes.row(i) = Monomials(Local(nodes_.col(i)));
  }
  coefficients_ = InvertDensely(at_nodes);
  Eigen::Matrix4d coordinates;
  coordinates << Eigen::RowVector4d::Ones(), nodes_.leftCols<4>();
  volume_ = std::abs(coordinates.determinant()) / 6;
}

Eigen::Matrix<double, 10, 3> QuadraticShapeFunctions::Gradients(
    const Eigen::Vector3d& x) const {
  const Eigen::Vector3d y = Local(x);
  Eigen::Matrix<double, 3, 10> gradients;
  gradients << 0, 1, 0, 0, 2 * y(0), 0, 0, y(1), 0, y(2),  //
      0, 0, 1, 0, 0, 2 * y(1), 0, y(0), y(2), 0,           //
      0, 0, 0, 1, 0, 0, 2 * y(2), 0, y(1), y(0);
  return (gradients * coefficients_).transpose() / size_;
}

Eigen::Matrix<double, 6, 30> QuadraticShapeFunctions::StrainDisplacement(
    const Eigen::Vector3d& x) const {
  const Eigen::Matrix<double, 10, 3> gradients = Gradients(x);
  Eigen::Matrix<double, 6, 30> b;
  for (Eigen::Index i = 0; i < 10; ++i) {
    const Eigen::RowVector3d g = gradients.row(i);
    b.middleCols<3>(3 * i) << g(0), 0, 0, 0, g(1), 0, 0, 0, g(2),  //
        g(1), g(0), 0, 0, g(2), g(1), g(2), 0, g(0);
  }
  return b;
}

}  // namespace elastimate::testing
