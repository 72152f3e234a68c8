#include "elastimate/core/mesh/shape_functions.h"

#include <gtest/gtest.h>

#include <Eigen/LU>
#include <algorithm>
#include <cmath>

namespace elastimate {
namespace {

template <ElementKind kKind>
using Point = Eigen::Matrix<double, ElementSizes<kKind>::kDimension, 1>;

// The nodes of a reference element: the vertices, and the middles of edges,
// faces and the element.
template <ElementKind kKind>
std::vector<Point<kKind>> ReferenceNodes() {
  const ElementTopology& topology = TopologyOf(kKind);
  const bool is_simplex = IsSimplex(kKind);
  std::vector<Point<kKind>> nodes;
  for (int i = 0; i < topology.num_vertices; ++i) {
    Point<kKind> xi = Point<kKind>::Zero();
    for (int k = 0; k < topology.dimension; ++k) {
      const bool is_far[] = {i % 4 == 1 || i % 4 == 2, i % 4 >= 2, i >= 4};
      xi(k) = is_simplex ? double(k == i - 1) : (is_far[k] ? 1 : -1);
    }
    nodes.push_back(xi);
  }
  for (int i = topology.num_vertices; i < topology.num_nodes; ++i) {
    Point<kKind> sum = Point<kKind>::Zero();
    const std::vector<int>& middle =
        topology.middles[i - topology.num_vertices];
    for (const int vertex : middle) {
      sum += nodes[vertex];
    }
    nodes.push_back(sum / double(middle.size()));
  }
  return nodes;
}

template <ElementKind kKind>
Point<kKind> SomePoint() {
  const double xi[] = {0.21, 0.37, 0.11};
  return Eigen::Map<const Point<kKind>>(xi);
}

// Calls check with the constant of each kind.
template <class Check>
void ForEachKind(const Check& check) {
  for (const ElementKind kind : kElementKinds) {
    SCOPED_TRACE(TopologyOf(kind).name);
    VisitElementKind(kind, [&](auto constant) {
      ASSERT_EQ(decltype(constant)::value, kind);
      check(constant);
    });
  }
}

TEST(ShapeFunctions, AreOneAtTheirNodeAndZeroAtTheOthers) {
  ForEachKind([](auto kind) {
    const auto nodes = ReferenceNodes<kind>();
    ASSERT_EQ(int(nodes.size()), ElementSizes<kind>::kNodes);
    for (int i = 0; i < ElementSizes<kind>::kNodes; ++i) {
      const auto at = ShapeFunctionsAt<kind>(nodes[i], 1);
      for (int j = 0; j < ElementSizes<kind>::kNodes; ++j) {
        EXPECT_NEAR(at.value(j), i == j ? 1 : 0, 1e-15);
      }
    }
  });
}

TEST(ShapeFunctions, AddUpToOne) {
  ForEachKind([](auto kind) {
    const auto at = ShapeFunctionsAt<kind>(SomePoint<kind>(), 1);
    EXPECT_NEAR(at.value.sum(), 1, 1e-15);
    EXPECT_NEAR(at.vertex_value.sum(), 1, 1e-15);
    EXPECT_LT(at.gradient.rowwise().sum().cwiseAbs().maxCoeff(), 1e-15);
    EXPECT_LT(at.vertex_gradient.rowwise().sum().cwiseAbs().maxCoeff(), 1e-15);
  });
}

TEST(ShapeFunctions, HaveTheGradientsOfFiniteDifferences) {
  constexpr double kStep = 1e-5;
  ForEachKind([](auto kind) {
    const auto at = ShapeFunctionsAt<kind>(SomePoint<kind>(), 1);
    for (int k = 0; k < ElementSizes<kind>::kDimension; ++k) {
      Point<kind> low = SomePoint<kind>();
      Point<kind> high = low;
      low(k) -= kStep;
      high(k) += kStep;
      const auto before = ShapeFunctionsAt<kind>(low, 1);
      const auto after = ShapeFunctionsAt<kind>(high, 1);
      EXPECT_TRUE(at.gradient.row(k).transpose().isApprox(
          (after.value - before.value) / (2 * kStep), 1e-9));
      EXPECT_TRUE(at.vertex_gradient.row(k).transpose().isApprox(
          (after.vertex_value - before.vertex_value) / (2 * kStep), 1e-9));
    }
  });
}

// Weights add up to the volume, and products of two linear functions are
// integrated exactly: that of xi_k^2 over a simplex is 2 / (dimension + 2)!,
// over a cube 2^dimension / 3.
TEST(IntegrationRule, IsExactForProductsOfLinearFunctions) {
  ForEachKind([](auto kind) {
    constexpr int kDimension = ElementSizes<kind>::kDimension;
    const double volume = !IsSimplex(kind)  ? std::pow(2, kDimension)
                          : kDimension == 3 ? 1.0 / 6
                                            : 0.5;
    const double moment = !IsSimplex(kind)  ? volume / 3
                          : kDimension == 3 ? 2.0 / 120
                                            : 2.0 / 24;
    double sum = 0;
    double square_sum = 0;
    for (const auto& at : IntegrationRule<kind>()) {
      // The first coordinate, from those of the vertices.
      double xi = 0;
      const auto nodes = ReferenceNodes<kind>();
      for (int i = 0; i < ElementSizes<kind>::kVertices; ++i) {
        xi += at.vertex_value(i) * nodes[i](0);
      }
      sum += at.weight;
      square_sum += at.weight * xi * xi;
    }
    const double rounding = std::max(
        1e-15, 1e-16 * volume * double(IntegrationRule<kind>().size()));
    EXPECT_NEAR(sum, volume, rounding);
    EXPECT_NEAR(square_sum, moment, rounding);
    double stiffness_sum = 0;
    for (const auto& at : StiffnessRule<kind>()) {
      stiffness_sum += at.weight;
    }
    double vertex_sum = 0;
    for (const auto& at : VertexRule<kind>()) {
      vertex_sum += at.weight;
    }
    EXPECT_NEAR(stiffness_sum, volume, rounding);
    EXPECT_NEAR(vertex_sum, volume, 1e-15);
  });
}

double Factorial(int n) { return n == 0 ? 1 : n * Factorial(n - 1); }

// The integral of x^a y^b z^c over the reference simplex is
// a! b! c! / (a + b + c + dimension)!.
template <ElementKind kKind>
void ExpectExactUpTo(int degree) {
  constexpr int kDimension = ElementSizes<kKind>::kDimension;
  for (int a = 0; a <= degree; ++a) {
    for (int b = 0; a + b <= degree; ++b) {
      for (int c = 0; c <= (kDimension == 3 ? degree - a - b : 0); ++c) {
        double sum = 0;
        for (const auto& at : IntegrationRule<kKind>()) {
          EXPECT_GT(at.weight, 0);
          sum += at.weight * std::pow(at.vertex_value(1), a) *
                 std::pow(at.vertex_value(2), b) *
                 std::pow(at.vertex_value(kDimension), c);
        }
        EXPECT_NEAR(sum,
                    Factorial(a) * Factorial(b) * Factorial(c) /
                        Factorial(a + b + c + kDimension),
                    1e-16)
            << a << b << c;
      }
    }
  }
}

TEST(IntegrationRule, IsExactForWhatCurvedElementsHoldOfAUniformForce) {
  ExpectExactUpTo<ElementKind::kCurvedTet10>(5);
  ExpectExactUpTo<ElementKind::kCurvedTri6>(4);
}

// The integral of x^a y^b z^c over the cube is the product of 2 / (a + 1) for
// even a, and 0 for odd ones.
template <ElementKind kKind>
void ExpectExactAlongAxesUpTo(int degree) {
  constexpr int kDimension = ElementSizes<kKind>::kDimension;
  const auto nodes = ReferenceNodes<kKind>();
  const auto along_axis = [](int power) {
    return power % 2 == 0 ? 2.0 / (power + 1) : 0.0;
  };
  for (int a = 0; a <= degree; ++a) {
    for (int b = 0; b <= degree; ++b) {
      for (int c = 0; c <= (kDimension == 3 ? degree : 0); ++c) {
        double sum = 0;
        for (const auto& at : IntegrationRule<kKind>()) {
          Point<kKind> xi = Point<kKind>::Zero();
          for (int i = 0; i < ElementSizes<kKind>::kVertices; ++i) {
            xi += at.vertex_value(i) * nodes[i];
          }
          sum += at.weight * std::pow(xi(0), a) * std::pow(xi(1), b) *
                 std::pow(xi(kDimension - 1), c);
        }
        EXPECT_NEAR(sum,
                    along_axis(a) * along_axis(b) *
                        (kDimension == 3 ? along_axis(c) : 1),
                    1e-14)
            << a << b << c;
      }
    }
  }
}

TEST(IntegrationRule, IsExactForProductsOfPolynomialsOfEachAxis) {
  ExpectExactAlongAxesUpTo<ElementKind::kHex8>(3);
  ExpectExactAlongAxesUpTo<ElementKind::kQuad4>(3);
  ExpectExactAlongAxesUpTo<ElementKind::kHex27>(5);
  ExpectExactAlongAxesUpTo<ElementKind::kQuad9>(5);
}

}  // namespace
}  // namespace elastimate
