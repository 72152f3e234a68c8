#include "elastimate/core/mesh/element_kind.h"

#include <algorithm>
#include <cassert>
#include <numeric>

namespace elastimate {
namespace {

using Vertices = std::vector<std::vector<int>>;

// Face i of a tetrahedron is opposite to vertex i.
const Vertices kTetrahedronFaces = {{1, 2, 3}, {0, 3, 2}, {0, 1, 3}, {0, 2, 1}};
const std::vector<std::array<int, 2>> kTetrahedronEdges = {
    {0, 1}, {1, 2}, {2, 0}, {0, 3}, {1, 3}, {2, 3}};
const Vertices kTetrahedronCorners = {{0, 1, 2, 3}};

// The faces are in the order in which VTK has the nodes in their middles.
const Vertices kHexahedronFaces = {{0, 4, 7, 3}, {1, 2, 6, 5}, {0, 1, 5, 4},
                                   {3, 7, 6, 2}, {0, 3, 2, 1}, {4, 5, 6, 7}};
const std::vector<std::array<int, 2>> kHexahedronEdges = {
    {0, 1}, {1, 2}, {2, 3}, {3, 0}, {4, 5}, {5, 6},
    {6, 7}, {7, 4}, {0, 4}, {1, 5}, {2, 6}, {3, 7}};
const Vertices kHexahedronCorners = {{0, 1, 3, 4}, {1, 2, 0, 5}, {2, 3, 1, 6},
                                     {3, 0, 2, 7}, {4, 7, 5, 0}, {5, 4, 6, 1},
                                     {6, 5, 7, 2}, {7, 6, 4, 3}};

const Vertices kTriangleFaces = {{0, 1}, {1, 2}, {2, 0}};
const std::vector<std::array<int, 2>> kTriangleEdges = {{0, 1}, {1, 2}, {2, 0}};
const Vertices kTriangleCorners = {{0, 1, 2}};

const Vertices kQuadrilateralFaces = {{0, 1}, {1, 2}, {2, 3}, {3, 0}};
const std::vector<std::array<int, 2>> kQuadrilateralEdges = {
    {0, 1}, {1, 2}, {2, 3}, {3, 0}};
const Vertices kQuadrilateralCorners = {
    {0, 1, 3}, {1, 2, 0}, {2, 3, 1}, {3, 0, 2}};

Vertices MiddlesOf(const std::vector<std::array<int, 2>>& edges,
                   const Vertices& faces, int num_vertices) {
  // Each face of a simplex is opposite to a vertex.
  const bool is_simplex = faces.size() == std::size_t(num_vertices) &&
                          faces[0].size() + 1 == std::size_t(num_vertices);
  Vertices middles;
  for (const auto& [a, b] : edges) {
    middles.push_back({a, b});
  }
  if (faces[0].size() == 4) {
    middles.insert(middles.end(), faces.begin(), faces.end());
  }
  if (!is_simplex) {
    std::vector<int> all(num_vertices);
    std::iota(all.begin(), all.end(), 0);
    middles.push_back(all);
  }
  return middles;
}

Vertices MiddlesOfFace(std::size_t num_vertices) {
  if (num_vertices == 2) {
    return {{0, 1}};
  }
  return num_vertices == 3
             ? MiddlesOf(kTriangleEdges, kTriangleFaces, 3)
             : MiddlesOf(kQuadrilateralEdges, kQuadrilateralFaces, 4);
}

ElementTopology Tetrahedron(std::string_view name, int order) {
  return {name,
          "tetrahedron",
          "tetrahedra",
          3,
          order,
          order == 1 ? 4 : 10,
          4,
          kTetrahedronEdges,
          kTetrahedronFaces,
          MiddlesOf(kTetrahedronEdges, kTetrahedronFaces, 4),
          MiddlesOfFace(3),
          kTetrahedronCorners};
}

ElementTopology Hexahedron(std::string_view name, int order) {
  return {name,
          "hexahedron",
          "hexahedra",
          3,
          order,
          order == 1 ? 8 : 27,
          8,
          kHexahedronEdges,
          kHexahedronFaces,
          MiddlesOf(kHexahedronEdges, kHexahedronFaces, 8),
          MiddlesOfFace(4),
          kHexahedronCorners};
}

ElementTopology Triangle(std::string_view name, int order) {
  return {name,
          "triangle",
          "triangles",
          2,
          order,
          order == 1 ? 3 : 6,
          3,
          kTriangleEdges,
          kTriangleFaces,
          MiddlesOf(kTriangleEdges, kTriangleFaces, 3),
          MiddlesOfFace(2),
          kTriangleCorners};
}

ElementTopology Quadrilateral(std::string_view name, int order) {
  return {name,
          "quadrilateral",
          "quadrilaterals",
          2,
          order,
          order == 1 ? 4 : 9,
          4,
          kQuadrilateralEdges,
          kQuadrilateralFaces,
          MiddlesOf(kQuadrilateralEdges, kQuadrilateralFaces, 4),
          MiddlesOfFace(2),
          kQuadrilateralCorners};
}

// In the order of ElementKind.
const std::array<ElementTopology, kElementKinds.size()> kTopologies = {
    Tetrahedron("tet4", 1),
    Tetrahedron("tet10", 2),
    Tetrahedron("curved_tet10", 2),
    Hexahedron("hex8", 1),
    Hexahedron("hex27", 2),
    Triangle("tri3", 1),
    Triangle("tri6", 2),
    Triangle("curved_tri6", 2),
    Quadrilateral("quad4", 1),
    Quadrilateral("quad9", 2)};

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
