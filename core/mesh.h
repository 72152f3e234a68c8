#ifndef ELASTIMATE_CORE_MESH_H_
#define ELASTIMATE_CORE_MESH_H_

#include <Eigen/Core>

namespace elastimate {

/// A volume mesh of the specimen.
///
/// Lengths are in the scene's consistent unit system (m, N, Pa or mm, N, MPa,
/// ...).  The order of the nodes of an element is free: a tetrahedron of
/// negative orientation is the same tetrahedron, its volume is |det J| / 6.
struct Mesh {
  Eigen::Matrix3Xd nodes;  ///< 3 x num_nodes, positions [length].
  Eigen::MatrixXi
      elements;  ///< nodes_per_element x num_elements, zero-based node indices.
  Eigen::VectorXi regions;  ///< num_elements material region ids, or empty.

  Eigen::Index NumNodes() const { return nodes.cols(); }
  Eigen::Index NumElements() const { return elements.cols(); }
};

/// Throws std::invalid_argument, naming the node or the element, unless `mesh`
/// is one that the element kernels accept: at least one element, four nodes per
/// element, finite positions, an extent between 1e-50 and 1e50, node indices in
/// range, every node used by an element, no flat element (smallest height below
/// 1e-6 of the longest edge), and region ids for all elements or for none.
/// O(num_elements).
void ValidateMesh(const Mesh& mesh);

/// The outer surface: `3 x num_facets` node indices of the element faces that
/// belong to one element only, each ordered counter-clockwise seen from
/// outside, so that (x1 - x0) x (x2 - x0) is the outward normal times twice the
/// area.  Facets come in the order of the elements that own them.
/// O(num_elements).
Eigen::MatrixXi BoundaryFacets(const Mesh& mesh);

/// The smallest dihedral angle of each tetrahedron [rad], the usual measure of
/// a sliver.  num_elements values.
Eigen::VectorXd SmallestDihedralAngles(const Mesh& mesh);

}  // namespace elastimate

#endif  // ELASTIMATE_CORE_MESH_H_
