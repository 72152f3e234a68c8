#include "elastimate/core/mesh/shape_functions.h"

#include <vector>

namespace elastimate {
namespace {

// The vertices of the reference hexahedron; of the quadrilateral the first
// four.
constexpr double kCubeVertices[8][3] = {{-1, -1, -1}, {1, -1, -1}, {1, 1, -1},
                                        {-1, 1, -1},  {-1, -1, 1}, {1, -1, 1},
                                        {1, 1, 1},    {-1, 1, 1}};

template <ElementKind kKind>
using Point = Eigen::Matrix<double, ElementSizes<kKind>::kDimension, 1>;

// Values and gradients of the functions of order 1.
template <ElementKind kKind>
void SetVertexFunctions(const Point<kKind>& xi, ShapeFunctions<kKind>& at) {
  constexpr int kDimension = ElementSizes<kKind>::kDimension;
  if constexpr (IsSimplex(kKind)) {
    at.vertex_value << 1 - xi.sum(), xi;
    at.vertex_gradient.col(0).setConstant(-1);
    at.vertex_gradient.template rightCols<kDimension>().setIdentity();
  } else {
    for (int i = 0; i < ElementSizes<kKind>::kVertices; ++i) {
      Point<kKind> factor;
      for (int k = 0; k < kDimension; ++k) {
        factor(k) = (1 + kCubeVertices[i][k] * xi(k)) / 2;
      }
      at.vertex_value(i) = factor.prod();
      for (int k = 0; k < kDimension; ++k) {
        Point<kKind> derivative = factor;
        derivative(k) = kCubeVertices[i][k] / 2;
        at.vertex_gradient(k, i) = derivative.prod();
      }
    }
  }
}

// N_a = lambda_a (2 lambda_a - 1), N_ab = 4 lambda_a lambda_b.
template <ElementKind kKind>
void SetQuadraticFunctions(ShapeFunctions<kKind>& at) {
  constexpr int kVertices = ElementSizes<kKind>::kVertices;
  const auto& lambda = at.vertex_value;
  const auto& g = at.vertex_gradient;
  for (int a = 0; a < kVertices; ++a) {
    at.value(a) = lambda(a) * (2 * lambda(a) - 1);
    at.gradient.col(a) = (4 * lambda(a) - 1) * g.col(a);
  }
  const auto& edges = TopologyOf(kKind).edges;
  for (int i = 0; i < static_cast<int>(edges.size()); ++i) {
    const auto [a, b] = edges[i];
    at.value(kVertices + i) = 4 * lambda(a) * lambda(b);
    at.gradient.col(kVertices + i) =
        4 * (lambda(a) * g.col(b) + lambda(b) * g.col(a));
  }
}

template <ElementKind kKind>
std::vector<ShapeFunctions<kKind>> MakeIntegrationRule() {
  constexpr int kDimension = ElementSizes<kKind>::kDimension;
  std::vector<ShapeFunctions<kKind>> rule;
  if constexpr (IsSimplex(kKind)) {
    // Barycentric coordinates (b, a, a, a) and its permutations.
    const double a = kDimension == 3 ? (5 - std::sqrt(5.0)) / 20 : 1.0 / 6;
    const double b = 1 - kDimension * a;
    const double weight = kDimension == 3 ? 1.0 / 24 : 1.0 / 6;
    for (int i = 0; i <= kDimension; ++i) {
      Point<kKind> xi = Point<kKind>::Constant(a);
      if (i > 0) {
        xi(i - 1) = b;
      }
      rule.push_back(ShapeFunctionsAt<kKind>(xi, weight));
    }
  } else {
    for (int i = 0; i < ElementSizes<kKind>::kVertices; ++i) {
      Point<kKind> xi;
      for (int k = 0; k < kDimension; ++k) {
        xi(k) = kCubeVertices[i][k] / std::sqrt(3.0);
      }
      rule.push_back(ShapeFunctionsAt<kKind>(xi, 1));
    }
  }
  return rule;
}

template <ElementKind kKind>
std::vector<ShapeFunctions<kKind>> MakeVertexRule() {
  constexpr int kDimension = ElementSizes<kKind>::kDimension;
  std::vector<ShapeFunctions<kKind>> rule;
  for (int i = 0; i < ElementSizes<kKind>::kVertices; ++i) {
    Point<kKind> xi = Point<kKind>::Zero();
    double weight = 1;
    if constexpr (IsSimplex(kKind)) {
      weight = kDimension == 3 ? 1.0 / 24 : 1.0 / 6;
      if (i > 0) {
        xi(i - 1) = 1;
      }
    } else {
      for (int k = 0; k < kDimension; ++k) {
        xi(k) = kCubeVertices[i][k];
      }
    }
    rule.push_back(ShapeFunctionsAt<kKind>(xi, weight));
  }
  return rule;
}

}  // namespace

template <ElementKind kKind>
ShapeFunctions<kKind> ShapeFunctionsAt(
    const Eigen::Matrix<double, ElementSizes<kKind>::kDimension, 1>& xi,
    double weight) {
  ShapeFunctions<kKind> at;
  at.weight = weight;
  SetVertexFunctions<kKind>(xi, at);
  if constexpr (ElementSizes<kKind>::kNodes == ElementSizes<kKind>::kVertices) {
    at.value = at.vertex_value;
    at.gradient = at.vertex_gradient;
  } else {
    SetQuadraticFunctions<kKind>(at);
  }
  return at;
}

template <ElementKind kKind>
const std::vector<ShapeFunctions<kKind>>& IntegrationRule() {
  static const std::vector<ShapeFunctions<kKind>> rule =
      MakeIntegrationRule<kKind>();
  return rule;
}

template <ElementKind kKind>
const std::vector<ShapeFunctions<kKind>>& StiffnessRule() {
  if constexpr (kKind == ElementKind::kTet4 || kKind == ElementKind::kTri3) {
    constexpr int kDimension = ElementSizes<kKind>::kDimension;
    static const std::vector<ShapeFunctions<kKind>> rule = {
        ShapeFunctionsAt<kKind>(Point<kKind>::Constant(1.0 / (kDimension + 1)),
                                kDimension == 3 ? 1.0 / 6 : 1.0 / 2)};
    return rule;
  }
  return IntegrationRule<kKind>();
}

template <ElementKind kKind>
const std::vector<ShapeFunctions<kKind>>& VertexRule() {
  static const std::vector<ShapeFunctions<kKind>> rule =
      MakeVertexRule<kKind>();
  return rule;
}

#define ELASTIMATE_INSTANTIATE(kind)                                         \
  template ShapeFunctions<kind> ShapeFunctionsAt<kind>(                      \
      const Eigen::Matrix<double, ElementSizes<kind>::kDimension, 1>&,       \
      double);                                                               \
  template const std::vector<ShapeFunctions<kind>>& IntegrationRule<kind>(); \
  template const std::vector<ShapeFunctions<kind>>& StiffnessRule<kind>();   \
  template const std::vector<ShapeFunctions<kind>>& VertexRule<kind>();

ELASTIMATE_INSTANTIATE(ElementKind::kTet4)
ELASTIMATE_INSTANTIATE(ElementKind::kTet10)
ELASTIMATE_INSTANTIATE(ElementKind::kHex8)
ELASTIMATE_INSTANTIATE(ElementKind::kTri3)
ELASTIMATE_INSTANTIATE(ElementKind::kTri6)
ELASTIMATE_INSTANTIATE(ElementKind::kQuad4)

}  // namespace elastimate
