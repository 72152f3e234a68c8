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

/// The internal forces of a mesh of some materials, which are linear in their
/// moduli,
///
///   f(u; theta) = sum_k theta_k f_k(u),
///   f_k(u)_i = integral of P_k(grad u) grad(N_i) over the material of k,
///
/// and for small strains f_k(u) = K_k u, so that the stiffness is
/// K(theta) = sum_k theta_k K_k.  Moduli are in the order of
/// MaterialParameters.
///
/// All materials share one pass over the elements; of isotropic ones it is that
/// of StiffnessOperator.
class InternalForces {
 public:
  /// Preconditions: a valid mesh, valid materials of it.  Refers to `mesh`,
  /// which has to stay as it is; a temporary one does not compile.
  /// O(num_elements log num_materials).
  InternalForces(const Mesh& mesh, const std::vector<Material>& materials);
  InternalForces(const Mesh&&, const std::vector<Material>&) = delete;
  InternalForces(const InternalForces&) = delete;
  InternalForces& operator=(const InternalForces&) = delete;

  const MaterialParameters& Parameters() const { return parameters_; }

  /// f_k(u) of some displacements, num_dofs x n, for each modulus k.
  /// One element pass.
  std::vector<Eigen::MatrixXd> Products(
      const Eigen::MatrixXd& displacements) const;

  /// f_k(u) of one displacement (num_dofs) as columns: num_dofs x num_moduli.
  /// One element pass.
  Eigen::MatrixXd Columns(const Eigen::VectorXd& displacement) const;

  /// K(theta) V of some columns, num_dofs x n.  One element pass.
  Eigen::MatrixXd Multiply(const Eigen::VectorXd& moduli,
                           const Eigen::MatrixXd& displacements) const;

  /// K_ij(theta) of each pair of the graph of the mesh, dimension x dimension
  /// blocks side by side: dimension x (dimension num_pairs).
  /// One element pass; about a microsecond for a tetrahedron.
  Eigen::MatrixXd Blocks(const Eigen::VectorXd& moduli,
                         const NodeGraph& graph) const;

  /// Returns the blocks K_ii(theta) of all nodes side by side: dimension x
  /// num_dofs.
  /// One element pass.
  Eigen::MatrixXd DiagonalBlocks(const Eigen::VectorXd& moduli) const;

  /// The strain energy of each element over its volume [pressure], of one
  /// displacement (num_dofs): num_elements values.
  Eigen::VectorXd EnergyDensity(const Eigen::VectorXd& moduli,
                                const Eigen::VectorXd& displacement) const;

 private:
  /// What each modulus, by its place in its law, gives to each copy of a node.
  std::vector<Eigen::MatrixXd> OfParts(
      const Eigen::MatrixXd& displacements) const;
  /// Returns the moduli of H and of J in each element, 2 x num_elements.
  /// Precondition: all materials are isotropic.
  Eigen::Matrix2Xd ModuliOfElements(const Eigen::VectorXd& moduli) const;
  /// The tangent of each material.
  std::vector<Eigen::MatrixXd> Tangents(const Eigen::VectorXd& moduli) const;
  /// Returns the tangent of each unit modulus of the law of each material.
  std::vector<std::vector<Eigen::MatrixXd>> UnitTangents() const;

  const Mesh& mesh_;
  MaterialParameters parameters_;
  std::vector<int> material_of_element_;
  MaterialFrames frames_;
  /// Several materials have parts; the part of a single one is the whole mesh.
  MeshParts parts_;
  bool is_isotropic_;
  std::optional<StiffnessOperator> stiffness_;
};

}  // namespace elastimate

#endif  // ELASTIMATE_CORE_MECHANICS_INTERNAL_FORCES_H_
