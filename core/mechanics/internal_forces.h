#ifndef ELASTIMATE_CORE_MECHANICS_INTERNAL_FORCES_H_
#define ELASTIMATE_CORE_MECHANICS_INTERNAL_FORCES_H_

#include <Eigen/Core>
#include <optional>
#include <vector>

#include "elastimate/core/materials/material.h"
#include "elastimate/core/materials/material_frames.h"
#include "elastimate/core/materials/material_parameters.h"
#include "elastimate/core/mechanics/stiffness_product.h"
#include "elastimate/core/mesh/mesh.h"
#include "elastimate/core/mesh/mesh_parts.h"
#include "elastimate/core/mesh/node_graph.h"

namespace elastimate {

/// The internal forces of a mesh at small strains.  They are linear in the
/// moduli of its materials,
///
///   f(u; theta) = sum_k theta_k f_k(u),
///   f_k(u)_i = integral of P_k(grad u) grad(N_i) over the material of k,
///
/// which is f_k(u) = K_k u, so that the stiffness is
/// K(theta) = sum_k theta_k K_k.  Moduli are in the order of
/// MaterialParameters.
///
/// All materials share one pass over the elements.  Isotropic ones take the
/// pass of StiffnessOperator.
class InternalForces {
 public:
  /// Preconditions: a valid mesh, valid materials of it.  Refers to `mesh`,
  /// which has to stay as it is; a temporary one does not compile.  Throws
  /// std::invalid_argument for laws of large strains.
  /// O(num_elements log num_materials), and the cost of StiffnessOperator.
  InternalForces(const Mesh& mesh, const std::vector<Material>& materials);
  InternalForces(const Mesh&&, const std::vector<Material>&) = delete;
  InternalForces(const InternalForces&) = delete;
  InternalForces& operator=(const InternalForces&) = delete;

  const MaterialParameters& Parameters() const { return parameters_; }

  /// Returns f_k(u) for each modulus k and the columns u of `displacements`:
  /// num_dofs x n each.  One element pass.
  std::vector<Eigen::MatrixXd> Products(
      const Eigen::MatrixXd& displacements) const;

  /// Returns f_k(u) for one displacement (num_dofs) as columns: num_dofs x
  /// num_moduli.  One element pass.
  Eigen::MatrixXd Columns(const Eigen::VectorXd& displacement) const;

  /// Returns how the forces on one displacement change along directions
  /// d theta / dp (num_moduli x n): num_dofs x n.  One element pass.  For one
  /// direction no column but the result is made.
  Eigen::MatrixXd Along(const Eigen::MatrixXd& directions,
                        const Eigen::VectorXd& displacement) const;

  /// Returns K(theta) V for some columns V, num_dofs x n.  One element pass.
  Eigen::MatrixXd Multiply(const Eigen::VectorXd& moduli,
                           const Eigen::MatrixXd& displacements) const;

  /// Returns K_ij(theta) for each pair of the graph of the mesh, dimension x
  /// dimension blocks side by side: dimension x (dimension num_pairs).  One
  /// element pass; about a microsecond for a tetrahedron, a quarter of that if
  /// all materials are isotropic.
  Eigen::MatrixXd Blocks(const Eigen::VectorXd& moduli,
                         const NodeGraph& graph) const;

  /// Returns the blocks K_ii(theta) of all nodes side by side: dimension x
  /// num_dofs.
  /// One element pass.
  Eigen::MatrixXd DiagonalBlocks(const Eigen::VectorXd& moduli) const;

  /// Returns the strain energy of each element over its volume [pressure] for
  /// one displacement (num_dofs): num_elements values.
  Eigen::VectorXd EnergyDensity(const Eigen::VectorXd& moduli,
                                const Eigen::VectorXd& displacement) const;

 private:
  /// Returns the forces of each modulus, by its place in its law, on each copy
  /// of a node in `parts_`.
  std::vector<Eigen::MatrixXd> OfParts(
      const Eigen::MatrixXd& displacements) const;
  /// Returns the moduli of H and of J in each element, 2 x num_elements.
  /// Precondition: all materials are isotropic.
  Eigen::Matrix2Xd ModuliOfElements(const Eigen::VectorXd& moduli) const;
  /// Returns the tangent of each material.
  std::vector<Eigen::MatrixXd> Tangents(const Eigen::VectorXd& moduli) const;
  /// Returns, for each material, the tangent of each unit modulus of its law.
  std::vector<std::vector<Eigen::MatrixXd>> UnitTangents() const;

  const Mesh& mesh_;
  MaterialParameters parameters_;
  std::vector<int> material_of_element_;
  MaterialFrames frames_;
  /// The parts of the mesh if there is more than one material; else they are
  /// empty, and the whole mesh is the part.
  MeshParts parts_;
  bool is_isotropic_;
  /// Multiplies on the parts.
  std::optional<StiffnessOperator> stiffness_;
  /// Multiplies on the whole mesh; empty where that is the only part, and
  /// without HasQuadraticPass.
  std::optional<StiffnessOperator> stiffness_of_whole_;
};

}  // namespace elastimate

#endif  // ELASTIMATE_CORE_MECHANICS_INTERNAL_FORCES_H_
