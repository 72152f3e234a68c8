#include "elastimate/core/mesh/shape_functions.h"

#include <algorithm>
#include <array>
#include <vector>

namespace elastimate {
namespace {

// The vertices of the reference hexahedron.  The first four are those of the
// quadrilateral.
constexpr double kCubeVertices[8][3] = {{-1, -1, -1}, {1, -1, -1}, {1, 1, -1},
                                        {-1, 1, -1},  {-1, -1, 1}, {1, -1, 1},
                                        {1, 1, 1},    {-1, 1, 1}};

template <ElementKind kKind>
using Point = Eigen::Matrix<double, ElementSizes<kKind>::kDimension, 1>;

// Sets the values and gradients of the functions of order 1.
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

// Sets N_a = lambda_a (2 lambda_a - 1) and N_ab = 4 lambda_a lambda_b.
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

// The three quadratic functions of an interval from -1 to 1 that are 1 at -1, 0
// and 1.
struct IntervalFunctions {
  explicit IntervalFunctions(double t)
      : value{t * (t - 1) / 2, 1 - t * t, t * (t + 1) / 2},
        derivative{t - 0.5, -2 * t, t + 0.5} {}

  double value[3];
  double derivative[3];
};

// Sets the products of the functions of intervals.
template <ElementKind kKind>
void SetTensorFunctions(const Point<kKind>& xi, ShapeFunctions<kKind>& at) {
  constexpr int kDimension = ElementSizes<kKind>::kDimension;
  // The place of each node along each axis, 0 to 2.
  static const Eigen::MatrixXi places =
      (ReferenceNodes(kKind).array() + 1).matrix().cast<int>();
  for (int i = 0; i < ElementSizes<kKind>::kNodes; ++i) {
    at.value(i) = 1;
    at.gradient.col(i).setOnes();
    for (int k = 0; k < kDimension; ++k) {
      const IntervalFunctions along(xi(k));
      at.value(i) *= along.value[places(k, i)];
      for (int l = 0; l < kDimension; ++l) {
        at.gradient(l, i) *=
            (k == l ? along.derivative : along.value)[places(k, i)];
      }
    }
  }
}

// The points at all permutations of some barycentric coordinates, with the
// weight of each, relative to the size of the reference element.
struct Orbit {
  double weight;
  std::array<double, 4> barycentric;
};

template <ElementKind kKind>
std::vector<ShapeFunctions<kKind>> MakeCurvedRule() {
  constexpr int kDimension = ElementSizes<kKind>::kDimension;
  constexpr double kOfFaces = 0.31088591926330060980;
  constexpr double kOfVertices = 0.092735250310891226402;
  constexpr double kOfEdges = 0.045503704125649649492;
  constexpr double kOfSides = 0.44594849091596488632;
  constexpr double kOfCorners = 0.091576213509770743460;
  const std::vector<Orbit> orbits =
      kDimension == 3
          ? std::vector<Orbit>{{0.11268792571801585080,
                                {1 - 3 * kOfFaces, kOfFaces, kOfFaces,
                                 kOfFaces}},
                               {0.073493043116361949544,
                                {kOfVertices, kOfVertices, kOfVertices,
                                 1 - 3 * kOfVertices}},
                               {0.042546020777081466438,
                                {kOfEdges, kOfEdges, 0.5 - kOfEdges,
                                 0.5 - kOfEdges}}}
          : std::vector<Orbit>{{0.22338158967801146570,
                                {1 - 2 * kOfSides, kOfSides, kOfSides}},
                               {0.10995174365532186764,
                                {kOfCorners, kOfCorners, 1 - 2 * kOfCorners}}};
  std::vector<ShapeFunctions<kKind>> rule;
  for (Orbit orbit : orbits) {
    auto* const first = orbit.barycentric.data();
    do {
      rule.push_back(
          ShapeFunctionsAt<kKind>(Eigen::Map<const Point<kKind>>(first + 1),
                                  orbit.weight / (kDimension == 3 ? 6 : 2)));
    } while (std::next_permutation(first, first + kDimension + 1));
  }
  return rule;
}

template <ElementKind kKind>
std::vector<ShapeFunctions<kKind>> MakeIntegrationRule() {
  constexpr int kDimension = ElementSizes<kKind>::kDimension;
  std::vector<ShapeFunctions<kKind>> rule;
  if constexpr (IsCurved(kKind)) {
    rule = MakeCurvedRule<kKind>();
  } else if constexpr (IsSimplex(kKind)) {
    // The points are the permutations of the barycentric coordinates (b, a, a,
    // a).
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
  } else if constexpr (ElementSizes<kKind>::kNodes ==
                       ElementSizes<kKind>::kVertices) {
    for (int i = 0; i < ElementSizes<kKind>::kVertices; ++i) {
      Point<kKind> xi;
      for (int k = 0; k < kDimension; ++k) {
        xi(k) = kCubeVertices[i][k] / std::sqrt(3.0);
      }
      rule.push_back(ShapeFunctionsAt<kKind>(xi, 1));
    }
  } else {
    // The points of three along each axis lie as the nodes do.
    const Eigen::MatrixXd nodes = ReferenceNodes(kKind);
    for (const auto& node : nodes.colwise()) {
      double weight = 1;
      for (int k = 0; k < kDimension; ++k) {
        weight *= (node(k) == 0 ? 8.0 : 5.0) / 9;
      }
      rule.push_back(ShapeFunctionsAt<kKind>(std::sqrt(0.6) * node, weight));
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
  } else if constexpr (!IsSimplex(kKind)) {
    SetTensorFunctions<kKind>(xi, at);
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

Eigen::MatrixXd ReferenceNodes(ElementKind kind) {
  const ElementTopology& topology = TopologyOf(kind);
  const int dimension = topology.dimension;
  Eigen::MatrixXd nodes = Eigen::MatrixXd::Zero(dimension, topology.num_nodes);
  if (IsSimplex(kind)) {
    nodes.middleCols(1, dimension).setIdentity();
  } else {
    for (int i = 0; i < topology.num_vertices; ++i) {
      nodes.col(i) =
          Eigen::Map<const Eigen::VectorXd>(kCubeVertices[i], dimension);
    }
  }
  for (int i = topology.num_vertices; i < topology.num_nodes; ++i) {
    nodes.col(i) =
        nodes(Eigen::all, topology.middles[i - topology.num_vertices])
            .rowwise()
            .mean();
  }
  return nodes;
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
ELASTIMATE_INSTANTIATE(ElementKind::kCurvedTet10)
ELASTIMATE_INSTANTIATE(ElementKind::kHex8)
ELASTIMATE_INSTANTIATE(ElementKind::kHex27)
ELASTIMATE_INSTANTIATE(ElementKind::kTri3)
ELASTIMATE_INSTANTIATE(ElementKind::kTri6)
ELASTIMATE_INSTANTIATE(ElementKind::kCurvedTri6)
ELASTIMATE_INSTANTIATE(ElementKind::kQuad4)
ELASTIMATE_INSTANTIATE(ElementKind::kQuad9)

}  // namespace elastimate
