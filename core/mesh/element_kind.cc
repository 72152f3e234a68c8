#include "elastimate/core/mesh/element_kind.h"

#include <cassert>

namespace elastimate {
namespace {

// Face i of a tetrahedron is opposite to vertex i.
const std::vector<std::vector<int>> kTetrahedronFaces = {
    {1, 2, 3}, {0, 3, 2}, {0, 1, 3}, {0, 2, 1}};
const std::vector<std::array<int, 2>> kTetrahedronEdges = {
    {0, 1}, {1, 2}, {2, 0}, {0, 3}, {1, 3}, {2, 3}};
const std::vector<std::vector<int>> kTetrahedronCorners = {{0, 1, 2, 3}};

const std::vector<std::vector<int>> kHexahedronFaces = {
    {0, 3, 2, 1}, {4, 5, 6, 7}, {0, 1, 5, 4},
    {1, 2, 6, 5}, {2, 3, 7, 6}, {3, 0, 4, 7}};
const std::vector<std::array<int, 2>> kHexahedronEdges = {
    {0, 1}, {1, 2}, {2, 3}, {3, 0}, {4, 5}, {5, 6},
    {6, 7}, {7, 4}, {0, 4}, {1, 5}, {2, 6}, {3, 7}};
const std::vector<std::vector<int>> kHexahedronCorners = {
    {0, 1, 3, 4}, {1, 2, 0, 5}, {2, 3, 1, 6}, {3, 0, 2, 7},
    {4, 7, 5, 0}, {5, 4, 6, 1}, {6, 5, 7, 2}, {7, 6, 4, 3}};

const std::vector<std::vector<int>> kTriangleFaces = {{0, 1}, {1, 2}, {2, 0}};
const std::vector<std::array<int, 2>> kTriangleEdges = {{0, 1}, {1, 2}, {2, 0}};
const std::vector<std::vector<int>> kTriangleCorners = {{0, 1, 2}};

const std::vector<std::vector<int>> kQuadrilateralFaces = {
    {0, 1}, {1, 2}, {2, 3}, {3, 0}};
const std::vector<std::array<int, 2>> kQuadrilateralEdges = {
    {0, 1}, {1, 2}, {2, 3}, {3, 0}};
const std::vector<std::vector<int>> kQuadrilateralCorners = {
    {0, 1, 3}, {1, 2, 0}, {2, 3, 1}, {3, 0, 2}};

const std::array<ElementTopology, 8> kTopologies = {{
    {"tet4", "tetrahedron", "tetrahedra", 3, 1, 4, 4, kTetrahedronEdges,
     kTetrahedronFaces, kTetrahedronCorners},
    {"tet10", "tetrahedron", "tetrahedra", 3, 2, 10, 4, kTetrahedronEdges,
     kTetrahedronFaces, kTetrahedronCorners},
    {"curved_tet10", "tetrahedron", "tetrahedra", 3, 2, 10, 4,
     kTetrahedronEdges, kTetrahedronFaces, kTetrahedronCorners},
    {"hex8", "hexahedron", "hexahedra", 3, 1, 8, 8, kHexahedronEdges,
     kHexahedronFaces, kHexahedronCorners},
    {"tri3", "triangle", "triangles", 2, 1, 3, 3, kTriangleEdges,
     kTriangleFaces, kTriangleCorners},
    {"tri6", "triangle", "triangles", 2, 2, 6, 3, kTriangleEdges,
     kTriangleFaces, kTriangleCorners},
    {"curved_tri6", "triangle", "triangles", 2, 2, 6, 3, kTriangleEdges,
     kTriangleFaces, kTriangleCorners},
    {"quad4", "quadrilateral", "quadrilaterals", 2, 1, 4, 4,
     kQuadrilateralEdges, kQuadrilateralFaces, kQuadrilateralCorners},
}};

}  // namespace

int ElementTopology::MidEdgeNode(int a, int b) const {
  for (int i = 0; order == 2 && i < static_cast<int>(edges.size()); ++i) {
    if ((edges[i][0] == a && edges[i][1] == b) ||
        (edges[i][0] == b && edges[i][1] == a)) {
      return num_vertices + i;
    }
  }
  return -1;
}

const ElementTopology& TopologyOf(ElementKind kind) {
  return kTopologies[static_cast<std::size_t>(kind)];
}

bool HasQuadraticKind(ElementKind kind) {
  return kind == ElementKind::kTet4 || kind == ElementKind::kTri3;
}

ElementKind QuadraticKind(ElementKind kind) {
  assert(HasQuadraticKind(kind));
  return kind == ElementKind::kTet4 ? ElementKind::kTet10 : ElementKind::kTri6;
}

ElementKind CurvedKind(ElementKind kind) {
  assert(TopologyOf(kind).order == 2);
  return DimensionOf(kind) == 3 ? ElementKind::kCurvedTet10
                                : ElementKind::kCurvedTri6;
}

}  // namespace elastimate
