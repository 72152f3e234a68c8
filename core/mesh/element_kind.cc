#include "elastimate/core/mesh/element_kind.h"

#include <algorithm>
#include <cassert>
#include <numeric>

namespace elastimate {
namespace {

using Vertices = std::vector<std::vector<int>>;

// What does not depend on the order of an element.
struct Shape {
  std::string_view name;
  std::string_view plural;
  int dimension;
  int num_vertices;
  std::vector<std::array<int, 2>> edges;
  Vertices faces;
  Vertices corners;
};

// Face i of a tetrahedron is opposite to vertex i.
const Shape kTetrahedron = {"tetrahedron",
                            "tetrahedra",
                            3,
                            4,
                            {{0, 1}, {1, 2}, {2, 0}, {0, 3}, {1, 3}, {2, 3}},
                            {{1, 2, 3}, {0, 3, 2}, {0, 1, 3}, {0, 2, 1}},
                            {{0, 1, 2, 3}}};

// The faces are in the order in which VTK has the nodes in their middles.
const Shape kHexahedron = {"hexahedron",
                           "hexahedra",
                           3,
                           8,
                           {{0, 1},
                            {1, 2},
                            {2, 3},
                            {3, 0},
                            {4, 5},
                            {5, 6},
                            {6, 7},
                            {7, 4},
                            {0, 4},
                            {1, 5},
                            {2, 6},
                            {3, 7}},
                           {{0, 4, 7, 3},
                            {1, 2, 6, 5},
                            {0, 1, 5, 4},
                            {3, 7, 6, 2},
                            {0, 3, 2, 1},
                            {4, 5, 6, 7}},
                           {{0, 1, 3, 4},
                            {1, 2, 0, 5},
                            {2, 3, 1, 6},
                            {3, 0, 2, 7},
                            {4, 7, 5, 0},
                            {5, 4, 6, 1},
                            {6, 5, 7, 2},
                            {7, 6, 4, 3}}};

const Shape kTriangle = {"triangle",
                         "triangles",
                         2,
                         3,
                         {{0, 1}, {1, 2}, {2, 0}},
                         {{0, 1}, {1, 2}, {2, 0}},
                         {{0, 1, 2}}};

const Shape kQuadrilateral = {"quadrilateral",
                              "quadrilaterals",
                              2,
                              4,
                              {{0, 1}, {1, 2}, {2, 3}, {3, 0}},
                              {{0, 1}, {1, 2}, {2, 3}, {3, 0}},
                              {{0, 1, 3}, {1, 2, 0}, {2, 3, 1}, {3, 0, 2}}};

Vertices MiddlesOf(const Shape& shape) {
  Vertices middles;
  for (const auto& [a, b] : shape.edges) {
    middles.push_back({a, b});
  }
  if (shape.faces[0].size() == 4) {
    middles.insert(middles.end(), shape.faces.begin(), shape.faces.end());
  }
  const bool is_simplex = shape.num_vertices == shape.dimension + 1;
  if (!is_simplex) {
    std::vector<int> all(shape.num_vertices);
    std::iota(all.begin(), all.end(), 0);
    middles.push_back(all);
  }
  return middles;
}

Vertices MiddlesOfFace(std::size_t num_vertices) {
  if (num_vertices == 2) {
    return {{0, 1}};
  }
  return MiddlesOf(num_vertices == 3 ? kTriangle : kQuadrilateral);
}

ElementTopology Topology(std::string_view name, int order, const Shape& shape) {
  const Vertices middles = MiddlesOf(shape);
  const int num_middles = order == 1 ? 0 : static_cast<int>(middles.size());
  return {name,
          shape.name,
          shape.plural,
          shape.dimension,
          order,
          shape.num_vertices + num_middles,
          shape.num_vertices,
          shape.edges,
          shape.faces,
          middles,
          MiddlesOfFace(shape.faces[0].size()),
          shape.corners};
}

// In the order of ElementKind.
const std::array<ElementTopology, kElementKinds.size()> kTopologies = {
    Topology("tet4", 1, kTetrahedron),
    Topology("tet10", 2, kTetrahedron),
    Topology("curved_tet10", 2, kTetrahedron),
    Topology("hex8", 1, kHexahedron),
    Topology("hex27", 2, kHexahedron),
    Topology("tri3", 1, kTriangle),
    Topology("tri6", 2, kTriangle),
    Topology("curved_tri6", 2, kTriangle),
    Topology("quad4", 1, kQuadrilateral),
    Topology("quad9", 2, kQuadrilateral)};

}  // namespace

int ElementTopology::MiddleNode(const std::vector<int>& vertices) const {
  for (std::size_t i = 0; order == 2 && i < middles.size(); ++i) {
    if (std::is_permutation(middles[i].begin(), middles[i].end(),
                            vertices.begin(), vertices.end())) {
      return num_vertices + static_cast<int>(i);
    }
  }
  return -1;
}

const ElementTopology& TopologyOf(ElementKind kind) {
  return kTopologies[static_cast<std::size_t>(kind)];
}

ElementKind QuadraticKind(ElementKind kind) {
  if (IsSimplex(kind)) {
    return DimensionOf(kind) == 3 ? ElementKind::kTet10 : ElementKind::kTri6;
  }
  return DimensionOf(kind) == 3 ? ElementKind::kHex27 : ElementKind::kQuad9;
}

ElementKind LinearKind(ElementKind kind) {
  if (IsSimplex(kind)) {
    return DimensionOf(kind) == 3 ? ElementKind::kTet4 : ElementKind::kTri3;
  }
  return DimensionOf(kind) == 3 ? ElementKind::kHex8 : ElementKind::kQuad4;
}

ElementKind CurvedKind(ElementKind kind) {
  assert(IsSimplex(kind) && TopologyOf(kind).order == 2);
  return DimensionOf(kind) == 3 ? ElementKind::kCurvedTet10
                                : ElementKind::kCurvedTri6;
}

}  // namespace elastimate
