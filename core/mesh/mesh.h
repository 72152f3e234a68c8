#ifndef ELASTIMATE_CORE_MESH_MESH_H_
#define ELASTIMATE_CORE_MESH_MESH_H_

#include <Eigen/Core>

#include "elastimate/core/mesh/element_kind.h"

namespace elastimate {

/// What a mesh stands for in space.
enum class SectionModel {
  kSolid,        ///< A body of three dimensions.
  kPlaneStrain,  ///< A slice of a body that cannot strain across it.
  kPlaneStress,  ///< A thin plate without stress across it.
};

/// All of them.
inline constexpr SectionModel kAllSectionModels[] = {
    SectionModel::kSolid, SectionModel::kPlaneStrain,
    SectionModel::kPlaneStress};

/// "3d", "plane_strain" or "plane_stress".
[[nodiscard]] std::string_view SectionModelName(SectionModel model);

/// The body that a mesh is a section of.
struct Section {
  SectionModel model = SectionModel::kSolid;
  /// The thickness of a planar section [length], which all volumes and areas
  /// contain; 1 in three dimensions.
  double thickness = 1;
  /// Standard deviation of the thickness, relative to it: it is one of every
  /// modulus, which no number of measurements averages.
  double thickness_relative_sd = 0;
};

/// A mesh of the specimen, of elements of one kind.
///
/// Lengths are in the scene's consistent unit system (m, N, Pa or mm, N, MPa,
/// ...).  The orientation of an element is free: one whose Jacobian determinant
/// is negative everywhere is the same element.
struct Mesh {
  ElementKind kind = ElementKind::kTet4;
  Section section;
  Eigen::MatrixXd nodes;  ///< dimension x num_nodes, positions [length].
  /// num_nodes of the kind x num_elements, zero-based node indices in the order
  /// of VTK: the vertices, then, in quadratic elements, the nodes of the edges
  /// (ElementTopology), which are in the middle unless the kind is curved.  In
  /// a quadratic mesh all vertices are numbered before all mid-edge nodes, and
  /// elements that share an edge share its node.
  Eigen::MatrixXi elements;
  Eigen::VectorXi regions;  ///< num_elements material region ids, or empty.

  const ElementTopology& Topology() const { return TopologyOf(kind); }
  /// 2 or 3.
  int Dimension() const { return DimensionOf(kind); }
  Eigen::Index NumNodes() const { return nodes.cols(); }
  Eigen::Index NumElements() const { return elements.cols(); }
  /// The degrees of freedom: row dimension * node + component of a vector.
  Eigen::Index NumDofs() const { return Dimension() * NumNodes(); }
  /// The order of the shape functions: 1 for linear, 2 for quadratic elements.
  int Order() const { return Topology().order; }
  /// The nodes that are vertices come first.  O(num_elements) for quadratic
  /// elements.
  Eigen::Index NumVertices() const;
};

/// Throws std::invalid_argument, naming the node or the element, unless `mesh`
/// is one that the element kernels accept: at least one element, as many nodes
/// per element and coordinates per node as its kind has, a section of the same
/// dimension with a positive thickness, finite positions, an extent between
/// 1e-50 and 1e50, node indices in range, every node used by an element, no
/// flat or folded element (a height at a vertex below 1e-6 of the longest edge
/// there, or vertices or integration points of different orientation), no
/// hexahedra with 3 nodes of a side in common but not the fourth, mid-edge
/// nodes after all vertices and, unless elements are curved, in the middle of
/// their edges (within 1e-6 of their length), and region ids for all elements
/// or for none.  O(num_elements), of hexahedra times a logarithm.
void ValidateMesh(const Mesh& mesh);

/// Whether `node` is in the middle between `a` and `b`, to within a millionth
/// of their distance: what single precision coordinates leave.
[[nodiscard]] bool IsInTheMiddle(const Mesh& mesh, int node, int a, int b);

/// The volume of each element [length^3], that of a planar one by its
/// thickness.  num_elements values.  O(num_elements).
[[nodiscard]] Eigen::VectorXd ElementVolumes(const Mesh& mesh);

/// The centre of an element: the mean of its vertices, dimension values.
[[nodiscard]] Eigen::VectorXd ElementCentre(const Mesh& mesh,
                                            Eigen::Index element);

/// The smallest dihedral angle of each tetrahedron [rad], the usual measure of
/// a sliver.  num_elements values.  Precondition: a mesh of tetrahedra.
[[nodiscard]] Eigen::VectorXd SmallestDihedralAngles(const Mesh& mesh);

}  // namespace elastimate

#endif  // ELASTIMATE_CORE_MESH_MESH_H_
