#ifndef ELASTIMATE_CORE_MESH_FACETS_H_
#define ELASTIMATE_CORE_MESH_FACETS_H_

#include <Eigen/Core>
#include <functional>
#include <optional>

#include "elastimate/core/mesh/mesh.h"

namespace elastimate {

// Facets are faces of elements, in two dimensions edges:
// num_nodes_of_face x num_facets node indices, vertices first, then the middle
// of the edges 01, 12, 20 of a triangle or of the edge 01.  A quadrilateral has
// the middles of the edges 01, 12, 23, 30, and then its own.

/// The outer surface: the faces that belong to one element only, each
/// counter-clockwise seen from outside, so that in three dimensions
/// (x1 - x0) x (x2 - x0) points outwards, and in two the outside is on the
/// right of the way from x0 to x1.  In the order of the elements that own them.
/// O(num_elements).
[[nodiscard]] Eigen::MatrixXi BoundaryFacets(const Mesh& mesh);

/// The element that each of these facets of BoundaryFacets belongs to, which
/// are in its order; middle nodes may be left out.  O(num_elements).
[[nodiscard]] Eigen::VectorXi ElementsOfFacets(const Mesh& mesh,
                                               const Eigen::MatrixXi& facets);

/// The facets of BoundaryFacets, in their order, all of whose nodes are
/// accepted.  O(num_elements).
[[nodiscard]] Eigen::MatrixXi BoundaryFacetsWhere(
    const Mesh& mesh, const std::function<bool(int)>& accepts_node);

/// The first facet that is no face of any element, in any order of vertices
/// around it, with its middles where elements are quadratic; empty
/// if each is one.  Precondition: NumNodesOfFace() nodes in range.
/// O(num_elements + num_facets log num_facets).
[[nodiscard]] std::optional<Eigen::Index> FirstThatIsNoFace(
    const Mesh& mesh, const Eigen::MatrixXi& facets);

/// The shares of the nodes of a facet in a uniform load.
struct FacetWeights {
  /// The integral of N_i over the facet, for each of its nodes [length^2].
  Eigen::VectorXd area;
  /// The integral of N_i n over the facet, where n is the outward normal:
  /// dimension x num_nodes_of_face [length^2].
  Eigen::MatrixXd area_vector;
};

/// Returns the weights of a facet.  Areas contain the thickness of a planar
/// section.  The weights are exact for straight edges and flat faces; a
/// quadrilateral takes 4 points, of order 2 it takes 9.  On curved facets the
/// area vectors are exact, and areas take 3 points in an edge or 6 in a
/// triangle.
[[nodiscard]] FacetWeights WeightsOfFacet(
    const Mesh& mesh, const Eigen::Ref<const Eigen::VectorXi>& facet);

/// Returns the mean outward normal of each facet, of length 1: dimension x
/// num_facets.  O(num_facets).
[[nodiscard]] Eigen::MatrixXd UnitNormals(const Mesh& mesh,
                                          const Eigen::MatrixXi& facets);

/// Returns the area of facets with nodes in range [length^2].  O(num_facets).
[[nodiscard]] double FacetArea(const Mesh& mesh, const Eigen::MatrixXi& facets);

/// All facets of a mesh, with the elements on either side.
struct ElementFacets {
  /// 2 x num_facets; the second is -1 for a facet of the outer surface.
  Eigen::Matrix2Xi elements;
  Eigen::VectorXd area;  ///< num_facets values [length^2].
};

/// Returns each facet of the mesh once.  Precondition: a valid mesh.
/// O(num_elements log num_elements).
[[nodiscard]] ElementFacets FacetsOfElements(const Mesh& mesh);

}  // namespace elastimate

#endif  // ELASTIMATE_CORE_MESH_FACETS_H_
