#ifndef ELASTIMATE_CORE_MESH_MESH_H_
#define ELASTIMATE_CORE_MESH_MESH_H_

#include <Eigen/Core>
#include <stdexcept>
#include <string>
#include <vector>

#include "elastimate/core/mesh/element_kind.h"

namespace elastimate {

/// The body in space for which a mesh stands.
enum class SectionModel {
  kSolid,        ///< The mesh itself, in three dimensions.
  kPlaneStrain,  ///< A planar slice of a body that cannot strain across it.
  kPlaneStress,  ///< A thin planar plate without stress across it.
};

/// All section models.
inline constexpr SectionModel kAllSectionModels[] = {
    SectionModel::kSolid, SectionModel::kPlaneStrain,
    SectionModel::kPlaneStress};

/// Returns "3d", "plane_strain" or "plane_stress".
[[nodiscard]] std::string_view SectionModelName(SectionModel model);

/// The body that a mesh is a section of.
struct Section {
  SectionModel model = SectionModel::kSolid;
  /// The thickness of a planar section [length], which all volumes and areas
  /// contain; 1 in three dimensions.
  double thickness = 1;
  /// The standard deviation of the thickness, relative to it.  It is a relative
  /// error of every modulus, which no number of measurements averages out.
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
  /// of VTK: the vertices, then, in quadratic elements, the nodes in the middle
  /// of edges, faces and elements (ElementTopology::middles), which may be
  /// beside the middle if the kind is curved.  In a quadratic mesh all vertices
  /// are numbered before all middle nodes, and elements that share an edge or a
  /// face share its node.
  Eigen::MatrixXi elements;
  Eigen::VectorXi regions;  ///< num_elements material region ids, or empty.

  const ElementTopology& Topology() const { return TopologyOf(kind); }
  /// 2 or 3.
  int Dimension() const { return DimensionOf(kind); }
  Eigen::Index NumNodes() const { return nodes.cols(); }
  Eigen::Index NumElements() const { return elements.cols(); }
  /// Counts the degrees of freedom: row dimension * node + component of a
  /// vector.
  Eigen::Index NumDofs() const { return Dimension() * NumNodes(); }
  /// Returns 1 for linear, 2 for quadratic shape functions.
  int Order() const { return Topology().order; }
  /// Counts the vertices, which come before all other nodes.  O(num_elements)
  /// for quadratic elements.
  Eigen::Index NumVertices() const;
};

/// What ValidateMesh throws for one element.
class InvalidElement : public std::invalid_argument {
 public:
  InvalidElement(Eigen::Index element, const std::string& sentence)
      : std::invalid_argument(sentence), element_(element) {}
  Eigen::Index Element() const { return element_; }

 private:
  Eigen::Index element_;
};

/// Throws std::invalid_argument, naming the node or the element, unless `mesh`
/// is one that the element kernels accept: at least one element, as many nodes
/// per element and coordinates per node as its kind has, a section of the same
/// dimension with a positive thickness, finite positions, an extent between
/// 1e-50 and 1e50, node indices in range, every node used by an element, no
/// flat or folded element (a height at a vertex below 1e-6 of the longest edge
/// there, or vertices or integration points of different orientation), no
/// hexahedra with 3 nodes of a side in common but not the fourth, middle nodes
/// after all vertices and, unless elements are curved, in the middle of their
/// vertices (IsInTheMiddle), and region ids for all elements or for none.
/// O(num_elements), of hexahedra times a logarithm.
void ValidateMesh(const Mesh& mesh);

/// Tells whether `node` is in the middle of some vertices, to within a
/// millionth of their largest distance from the first of them, which is the
/// error of single precision coordinates.
[[nodiscard]] bool IsInTheMiddle(const Mesh& mesh, int node,
                                 const std::vector<int>& vertices);

/// Returns the volume of each element [length^3], num_elements values.  The
/// volume of a planar element is its area times the thickness.
/// O(num_elements).
[[nodiscard]] Eigen::VectorXd ElementVolumes(const Mesh& mesh);

/// Returns the centre of an element, the mean of its vertices: dimension
/// values.
[[nodiscard]] Eigen::VectorXd ElementCentre(const Mesh& mesh,
                                            Eigen::Index element);

/// Returns the smallest dihedral angle of each tetrahedron [rad], the usual
/// measure of a sliver.  num_elements values.  Precondition: a mesh of
/// tetrahedra.
[[nodiscard]] Eigen::VectorXd SmallestDihedralAngles(const Mesh& mesh);

}  // namespace elastimate

#endif  // ELASTIMATE_CORE_MESH_MESH_H_
