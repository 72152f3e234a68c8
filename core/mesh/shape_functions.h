#ifndef ELASTIMATE_CORE_MESH_SHAPE_FUNCTIONS_H_
#define ELASTIMATE_CORE_MESH_SHAPE_FUNCTIONS_H_

#include <Eigen/Core>
#include <Eigen/LU>
#include <array>
#include <cmath>
#include <type_traits>
#include <vector>

#include "elastimate/core/mesh/element_kind.h"
#include "elastimate/core/mesh/mesh.h"

namespace elastimate {

/// The sizes of an element kind, known to the compiler.  The map from the
/// reference element takes the first kMapNodes nodes: all nodes of an
/// isoparametric element, the vertices of one with straight edges.
template <ElementKind kKind>
struct ElementSizes;
template <>
struct ElementSizes<ElementKind::kTet4> {
  static constexpr int kDimension = 3, kNodes = 4, kVertices = 4, kMapNodes = 4;
};
template <>
struct ElementSizes<ElementKind::kTet10> {
  static constexpr int kDimension = 3, kNodes = 10, kVertices = 4,
                       kMapNodes = 4;
};
template <>
struct ElementSizes<ElementKind::kCurvedTet10> {
  static constexpr int kDimension = 3, kNodes = 10, kVertices = 4,
                       kMapNodes = 10;
};
template <>
struct ElementSizes<ElementKind::kHex8> {
  static constexpr int kDimension = 3, kNodes = 8, kVertices = 8, kMapNodes = 8;
};
template <>
struct ElementSizes<ElementKind::kHex27> {
  static constexpr int kDimension = 3, kNodes = 27, kVertices = 8,
                       kMapNodes = 8;
};
template <>
struct ElementSizes<ElementKind::kTri3> {
  static constexpr int kDimension = 2, kNodes = 3, kVertices = 3, kMapNodes = 3;
};
template <>
struct ElementSizes<ElementKind::kTri6> {
  static constexpr int kDimension = 2, kNodes = 6, kVertices = 3, kMapNodes = 3;
};
template <>
struct ElementSizes<ElementKind::kCurvedTri6> {
  static constexpr int kDimension = 2, kNodes = 6, kVertices = 3, kMapNodes = 6;
};
template <>
struct ElementSizes<ElementKind::kQuad4> {
  static constexpr int kDimension = 2, kNodes = 4, kVertices = 4, kMapNodes = 4;
};
template <>
struct ElementSizes<ElementKind::kQuad9> {
  static constexpr int kDimension = 2, kNodes = 9, kVertices = 4, kMapNodes = 4;
};

/// The shape functions of an element kind at a point of its reference element.
template <ElementKind kKind>
struct ShapeFunctions {
  using Sizes = ElementSizes<kKind>;
  Eigen::Matrix<double, Sizes::kNodes, 1> value;  ///< N_i.
  /// dN_i / dxi, dimension x num_nodes.
  Eigen::Matrix<double, Sizes::kDimension, Sizes::kNodes> gradient;
  /// The functions of order 1 of the vertices alone.
  Eigen::Matrix<double, Sizes::kVertices, 1> vertex_value;
  Eigen::Matrix<double, Sizes::kDimension, Sizes::kVertices> vertex_gradient;
  double weight;  ///< The weight of this point in its rule.

  /// Returns dM_i / dxi, dimension x kMapNodes.  The position in the element is
  /// sum_i M_i x_i, over its vertices where edges are straight, else over all
  /// nodes.
  const auto& MapGradient() const {
    if constexpr (IsCurved(kKind)) {
      return gradient;
    } else {
      return vertex_gradient;
    }
  }
};

/// Evaluates the shape functions at the reference coordinates xi.  The vertices
/// of a tetrahedron have (0, 0, 0), (1, 0, 0), (0, 1, 0), (0, 0, 1), those of a
/// hexahedron +-1, and two dimensions are alike.
template <ElementKind kKind>
ShapeFunctions<kKind> ShapeFunctionsAt(
    const Eigen::Matrix<double, ElementSizes<kKind>::kDimension, 1>& xi,
    double weight);

/// Returns points and weights that integrate over the reference element.  They
/// are exact for products of two linear functions over a simplex with straight
/// edges (4 points in a tetrahedron, 3 in a triangle), and for cubics along
/// each axis of a hexahedron (8 points) or a quadrilateral (4) [Zienkiewicz &
/// Taylor, The Finite Element Method].  In those of order 2 they are exact for
/// polynomials of degree 5 along each axis (27 points, 9).
///
/// The determinant of the map of a curved simplex is of degree 3 (in a triangle
/// 2).  Polynomials of degree 5 (4), which is that of a shape function times
/// this determinant, are integrated exactly by 14 points [Walkington,
/// Quadrature on simplices of arbitrary dimension, 2000] (6 [Dunavant, Int. J.
/// Numer. Methods Eng. 21 (1985) 1129]).  Volumes, uniform body forces and the
/// forces of a uniform stress are then exact, and all weights are positive.
template <ElementKind kKind>
const std::vector<ShapeFunctions<kKind>>& IntegrationRule();

/// Returns the points that are enough for the stiffness: one in a linear
/// simplex, whose strain is constant, else those of IntegrationRule.
template <ElementKind kKind>
const std::vector<ShapeFunctions<kKind>>& StiffnessRule();

/// Returns the vertices.  The sum of the weights of IntegrationRule is shared
/// equally among them.
template <ElementKind kKind>
const std::vector<ShapeFunctions<kKind>>& VertexRule();

/// Returns the reference coordinates of the nodes of an element, dimension x
/// num_nodes.
Eigen::MatrixXd ReferenceNodes(ElementKind kind);

/// Returns the positions of the nodes of an element that its map takes,
/// dimension x kMapNodes.
template <ElementKind kKind>
Eigen::Matrix<double, ElementSizes<kKind>::kDimension,
              ElementSizes<kKind>::kMapNodes>
GatherMapNodes(const Mesh& mesh, Eigen::Index element) {
  using Sizes = ElementSizes<kKind>;
  Eigen::Matrix<double, Sizes::kDimension, Sizes::kMapNodes> x;
  const int* const nodes = mesh.elements.col(element).data();
  for (int i = 0; i < Sizes::kMapNodes; ++i) {
    x.col(i) = Eigen::Map<const Eigen::Matrix<double, Sizes::kDimension, 1>>(
        mesh.nodes.data() + Sizes::kDimension * Eigen::Index(nodes[i]));
  }
  return x;
}

/// Returns, for the nodes of an element, the components of a vector with rows
/// dimension * node + component: dimension x num_nodes.
template <ElementKind kKind>
Eigen::Matrix<double, ElementSizes<kKind>::kDimension,
              ElementSizes<kKind>::kNodes>
GatherNodes(const Mesh& mesh, Eigen::Index element, const double* values) {
  using Sizes = ElementSizes<kKind>;
  Eigen::Matrix<double, Sizes::kDimension, Sizes::kNodes> u;
  const int* const nodes = mesh.elements.col(element).data();
  for (int i = 0; i < Sizes::kNodes; ++i) {
    u.col(i) = Eigen::Map<const Eigen::Matrix<double, Sizes::kDimension, 1>>(
        values + Sizes::kDimension * Eigen::Index(nodes[i]));
  }
  return u;
}

/// The map from the reference element to an element at one of its points.
/// Where IsAffine, it is the same at all of them.
template <ElementKind kKind>
struct ElementMap {
  using Sizes = ElementSizes<kKind>;
  using Jacobian = Eigen::Matrix<double, Sizes::kDimension, Sizes::kDimension>;

  Jacobian inverse_transpose;  ///< (dx/dxi)^-T [1 / length].
  /// |det dx/dxi|, times the thickness of a planar section.
  double volume_ratio;

  /// `nodes` are those of GatherMapNodes; the thickness is 1 in three
  /// dimensions.
  ElementMap(
      const Eigen::Matrix<double, Sizes::kDimension, Sizes::kMapNodes>& nodes,
      const ShapeFunctions<kKind>& at, double thickness) {
    const Jacobian jacobian = nodes * at.MapGradient().transpose();
    inverse_transpose = jacobian.inverse().transpose();
    volume_ratio = std::abs(jacobian.determinant()) * thickness;
  }
};

/// An element of a mesh at one of the points of a rule.
template <ElementKind kKind>
struct ElementPoint {
  using Sizes = ElementSizes<kKind>;
  /// grad N_i, dimension x num_nodes [1 / length].
  Eigen::Matrix<double, Sizes::kDimension, Sizes::kNodes> gradient;
  double volume;  ///< The volume that the point has [length^3].

  ElementPoint(const ElementMap<kKind>& map, const ShapeFunctions<kKind>& at)
      : volume(map.volume_ratio * at.weight) {
    // Eigen would pack matrices of 27 columns for a large product.
    gradient = map.inverse_transpose.lazyProduct(at.gradient);
  }
};

/// Calls visit(ElementPoint, ShapeFunctions) at the points of a rule in an
/// element.
template <ElementKind kKind, class Visitor>
void VisitPoints(const Mesh& mesh, Eigen::Index element,
                 const std::vector<ShapeFunctions<kKind>>& rule,
                 const Visitor& visit) {
  const auto nodes = GatherMapNodes<kKind>(mesh, element);
  ElementMap<kKind> map(nodes, rule[0], mesh.section.thickness);
  for (std::size_t i = 0; i < rule.size(); ++i) {
    if (!IsAffine(kKind) && i > 0) {
      map = ElementMap<kKind>(nodes, rule[i], mesh.section.thickness);
    }
    visit(ElementPoint<kKind>(map, rule[i]), rule[i]);
  }
}

/// Calls `function` with the std::integral_constant of a kind.
template <class Function>
decltype(auto) VisitElementKind(ElementKind kind, Function&& function) {
  switch (kind) {
    case ElementKind::kTet4:
      return function(
          std::integral_constant<ElementKind, ElementKind::kTet4>());
    case ElementKind::kTet10:
      return function(
          std::integral_constant<ElementKind, ElementKind::kTet10>());
    case ElementKind::kCurvedTet10:
      return function(
          std::integral_constant<ElementKind, ElementKind::kCurvedTet10>());
    case ElementKind::kHex8:
      return function(
          std::integral_constant<ElementKind, ElementKind::kHex8>());
    case ElementKind::kHex27:
      return function(
          std::integral_constant<ElementKind, ElementKind::kHex27>());
    case ElementKind::kTri3:
      return function(
          std::integral_constant<ElementKind, ElementKind::kTri3>());
    case ElementKind::kTri6:
      return function(
          std::integral_constant<ElementKind, ElementKind::kTri6>());
    case ElementKind::kCurvedTri6:
      return function(
          std::integral_constant<ElementKind, ElementKind::kCurvedTri6>());
    case ElementKind::kQuad4:
      return function(
          std::integral_constant<ElementKind, ElementKind::kQuad4>());
    case ElementKind::kQuad9:
      break;
  }
  return function(std::integral_constant<ElementKind, ElementKind::kQuad9>());
}

}  // namespace elastimate

#endif  // ELASTIMATE_CORE_MESH_SHAPE_FUNCTIONS_H_
