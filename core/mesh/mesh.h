#ifndef ELASTIMATE_CORE_MESH_MESH_H_
#define ELASTIMATE_CORE_MESH_MESH_H_

#include <Eigen/Core>

namespace elastimate {

/// A volume mesh of the specimen.
///
/// Lengths are in the scene's consistent unit system (m, N, Pa or mm, N, MPa,
/// ...).  The order of the nodes of an element is free: a tetrahedron of
/// negative orientation is the same tetrahedron, its volume is |det J| / 6.
struct Mesh {
  Eigen::Matrix3Xd nodes;  ///< 3 x num_nodes, positions [length].
  /// nodes_per_element x num_elements, zero-based node indices: the 4 vertices
  /// of linear tetrahedra; for quadratic ones, whose edges are straight, then
  /// the nodes in the middle of the edges 01, 12, 20, 03, 13, 23 (the order of
  /// VTK).  In a quadratic mesh all vertices are numbered before all mid-edge
  /// nodes, and elements that share an edge share its node.
  Eigen::MatrixXi elements;
  Eigen::VectorXi regions;  ///< num_elements material region ids, or empty.

  Eigen::Index NumNodes() const { return nodes.cols(); }
  Eigen::Index NumElements() const { return elements.cols(); }
  /// The degree of the shape functions: 1 for linear, 2 for quadratic
  /// tetrahedra.
  int Order() const { return elements.rows() == 10 ? 2 : 1; }
  /// The nodes that are vertices come first.  O(num_elements) for quadratic
  /// tetrahedra.
  Eigen::Index NumVertices() const {
    return Order() == 1 ? NumNodes() : elements.topRows<4>().maxCoeff() + 1;
  }
};

/// Throws std::invalid_argument, naming the node or the element, unless `mesh`
/// is one that the element kernels accept: at least one element, 4 or 10 nodes
/// per element, finite positions, an extent between 1e-50 and 1e50, node
/// indices in range, every node used by an element, no flat element (smallest
/// height below 1e-6 of the longest edge), mid-edge nodes numbered after the
/// vertices and in the middle of their edges (within 1e-6 of their length), and
/// region ids for all elements or for none.
/// O(num_elements).
void ValidateMesh(const Mesh& mesh);

/// The outer surface: `3 x num_facets` node indices of the element faces that
/// belong to one element only, each ordered counter-clockwise seen from
/// outside, so that (x1 - x0) x (x2 - x0) is the outward normal times twice the
/// area.  For quadratic tetrahedra `6 x num_facets`: the nodes in the middle of
/// the edges 01, 12, 20 follow.  Facets come in the order of the elements that
/// own them.
/// O(num_elements).
Eigen::MatrixXi BoundaryFacets(const Mesh& mesh);

/// The smallest dihedral angle of each tetrahedron [rad], the usual measure of
/// a sliver.  num_elements values.
Eigen::VectorXd SmallestDihedralAngles(const Mesh& mesh);

}  // namespace elastimate

#endif  // ELASTIMATE_CORE_MESH_MESH_H_
