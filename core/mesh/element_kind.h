#ifndef ELASTIMATE_CORE_MESH_ELEMENT_KIND_H_
#define ELASTIMATE_CORE_MESH_ELEMENT_KIND_H_

#include <array>
#include <cstdint>
#include <string_view>
#include <vector>

#include "elastimate/core/algebra/eigen_abi.h"

namespace elastimate {

/// The finite elements that a mesh may be made of.  Their nodes are in the
/// order of VTK.
enum class ElementKind {
  kTet4,   ///< The linear tetrahedron.
  kTet10,  ///< The quadratic tetrahedron with straight edges.
  /// The isoparametric quadratic tetrahedron: its shape functions map the
  /// reference element to it too, so that its edges and faces may be curved.
  kCurvedTet10,
  kHex8,        ///< The trilinear hexahedron.
  kHex27,       ///< The triquadratic hexahedron with straight edges.
  kTri3,        ///< The linear triangle.
  kTri6,        ///< The quadratic triangle with straight edges.
  kCurvedTri6,  ///< The isoparametric quadratic triangle.
  kQuad4,       ///< The bilinear quadrilateral.
  kQuad9,       ///< The biquadratic quadrilateral with straight edges.
};

inline constexpr std::array<ElementKind, 10> kElementKinds = {
    ElementKind::kTet4, ElementKind::kTet10,      ElementKind::kCurvedTet10,
    ElementKind::kHex8, ElementKind::kHex27,      ElementKind::kTri3,
    ElementKind::kTri6, ElementKind::kCurvedTri6, ElementKind::kQuad4,
    ElementKind::kQuad9};

/// 2 or 3.
constexpr int DimensionOf(ElementKind kind) {
  return kind >= ElementKind::kTri3 ? 2 : 3;
}

/// Tells whether it is a tetrahedron or a triangle.
constexpr bool IsSimplex(ElementKind kind) {
  return kind != ElementKind::kHex8 && kind != ElementKind::kHex27 &&
         kind != ElementKind::kQuad4 && kind != ElementKind::kQuad9;
}

/// Tells whether its nodes in the middle of edges may be off the straight line.
constexpr bool IsCurved(ElementKind kind) {
  return kind == ElementKind::kCurvedTet10 || kind == ElementKind::kCurvedTri6;
}

/// Tells whether the map from the reference element to it is affine.
constexpr bool IsAffine(ElementKind kind) {
  return IsSimplex(kind) && !IsCurved(kind);
}

/// How the nodes of an element lie to each other.
struct ElementTopology {
  std::string_view name;    ///< "tet4" and so on.
  std::string_view shape;   ///< "tetrahedron" and so on.
  std::string_view shapes;  ///< "tetrahedra" and so on.
  int dimension;            ///< 2 or 3.
  int order;  ///< 1 for (bi-, tri-)linear shape functions, else 2.
  int num_nodes;
  /// The vertices are the first nodes of an element.
  int num_vertices;
  /// The vertices at either end of each edge.
  std::vector<std::array<int, 2>> edges;
  /// The vertices of each face (in two dimensions of each edge) of an element
  /// of positive orientation, counter-clockwise seen from outside.
  std::vector<std::vector<int>> faces;
  /// The vertices that the nodes of an element of order 2 behind the vertices
  /// are in the middle of: the ends of each edge; in a hexahedron then the
  /// vertices of each face; in a hexahedron or a quadrilateral last all
  /// vertices.
  std::vector<std::vector<int>> middles;
  /// The middles of a facet, by the places of its vertices in it.
  std::vector<std::vector<int>> middles_of_face;
  /// For each vertex, the ends of `dimension` edges from it, right-handed in an
  /// element of positive orientation.  An element is flat or folded where these
  /// edges are.  A simplex needs the corner of one vertex only.
  std::vector<std::vector<int>> corners;

  /// Returns "tetrahedron" for one, "tetrahedra" for another number.
  std::string_view ShapeName(std::int64_t count) const {
    return count == 1 ? shape : shapes;
  }
  int NumVerticesOfFace() const { return static_cast<int>(faces[0].size()); }
  /// Counts the vertices of a face and, where the order is 2, its middles.
  int NumNodesOfFace() const {
    return order == 1
               ? NumVerticesOfFace()
               : NumVerticesOfFace() + static_cast<int>(middles_of_face.size());
  }
  /// Returns the node in the middle of some vertices, in any order, or -1 where
  /// there is none.
  int MiddleNode(const std::vector<int>& vertices) const;
};

[[nodiscard]] const ElementTopology& TopologyOf(ElementKind kind);

/// Returns the kind of order 2 with the same vertices and straight edges.
[[nodiscard]] ElementKind QuadraticKind(ElementKind kind);

/// Returns the kind of order 1 with the same vertices.
[[nodiscard]] ElementKind LinearKind(ElementKind kind);

/// Returns the curved kind of a quadratic simplex.
[[nodiscard]] ElementKind CurvedKind(ElementKind kind);

}  // namespace elastimate

#endif  // ELASTIMATE_CORE_MESH_ELEMENT_KIND_H_
