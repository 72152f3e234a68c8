#ifndef ELASTIMATE_CORE_MECHANICS_LARGE_STRAIN_FORCES_H_
#define ELASTIMATE_CORE_MECHANICS_LARGE_STRAIN_FORCES_H_

#include <Eigen/Core>
#include <vector>

#include "elastimate/core/materials/material.h"
#include "elastimate/core/materials/material_frames.h"
#include "elastimate/core/materials/material_parameters.h"
#include "elastimate/core/mesh/mesh.h"
#include "elastimate/core/mesh/node_graph.h"

namespace elastimate {

/// The volume that an element evaluates.
enum class Dilatation {
  kOfPoints,  ///< J = det F at each point of the integration.
  /// The mean of J over each linear hexahedron, or quadrilateral in plane
  /// strain, and its least-squares fit by a linear function over each quadratic
  /// one, which do not lock where the material is nearly incompressible.  Other
  /// elements are as above.
  kMeanOfElement,
};

/// How much the volume changes.
struct VolumeRatio {
  double value;          ///< det F, in the plane that of a planar mesh.
  Eigen::Index element;  ///< Where it is.
};

/// The internal forces of a mesh of some materials at a displacement u of any
/// size.  They are linear in the moduli,
///
///   f(u; theta) = sum_k theta_k f_k(u),
///   f_k(u)_i = integral of P_k(grad u) grad(N_i) over the material of k,
///
/// over the undeformed mesh, and their tangent K = df / du is symmetric.
///
/// With the mean dilatation Theta = (integral of J) / V of an element, or its
/// linear fit, laws have Fbar = (Theta / J)^(1/3) F in place of F, and forces
/// are derivatives of their energy: those of the method of three fields with a
/// constant (linear) pressure and volume [Simo, Taylor & Pister, Comput.
/// Methods Appl. Mech. Eng. 51 (1985) 177] after these two are eliminated.
///
/// In plane stress, the stretch across the plate depends on the moduli.  A
/// column f_k is evaluated at the stretch that belongs to the given moduli, so
/// that the columns differ from the derivatives of f by the moduli.
class LargeStrainForces {
 public:
  /// Preconditions: a valid mesh, valid materials of it.  Refers to `mesh`,
  /// which has to stay as it is; a temporary one does not compile.  Throws
  /// std::invalid_argument for laws of small strains.
  LargeStrainForces(const Mesh& mesh, const std::vector<Material>& materials,
                    Dilatation dilatation = Dilatation::kMeanOfElement);
  LargeStrainForces(const Mesh&&, const std::vector<Material>&,
                    Dilatation = Dilatation::kMeanOfElement) = delete;

  const MaterialParameters& Parameters() const { return parameters_; }

  /// Evaluates the volume in another way from now on.
  void SetDilatation(Dilatation dilatation) { dilatation_ = dilatation; }
  Dilatation GetDilatation() const { return dilatation_; }

  /// Returns f_k(u) as columns, num_dofs x num_moduli.  One element pass.
  Eigen::MatrixXd Columns(const Eigen::VectorXd& moduli,
                          const Eigen::VectorXd& displacement) const;

  /// Returns f(u; theta), num_dofs.  One element pass.
  Eigen::VectorXd Forces(const Eigen::VectorXd& moduli,
                         const Eigen::VectorXd& displacement) const {
    return Columns(moduli, displacement) * moduli;
  }

  /// Returns df(u; theta) / dtheta_k as columns, num_dofs x num_moduli. Outside
  /// plane stress these are f_k(u).  One element pass, and one more of tangents
  /// in plane stress.
  Eigen::MatrixXd ModuliDerivatives(const Eigen::VectorXd& moduli,
                                    const Eigen::VectorXd& displacement) const;

  /// Returns K_ij(u; theta) for each pair of the graph of the mesh, dimension x
  /// dimension blocks side by side: dimension x (dimension num_pairs).  One
  /// element pass.
  Eigen::MatrixXd TangentBlocks(const Eigen::VectorXd& moduli,
                                const Eigen::VectorXd& displacement,
                                const NodeGraph& graph) const;

  /// Returns K(u; theta) V for some columns V, num_dofs x n.  One element pass.
  Eigen::MatrixXd TangentProducts(const Eigen::VectorXd& moduli,
                                  const Eigen::VectorXd& displacement,
                                  const Eigen::MatrixXd& directions) const;

  /// Returns where det F is smallest.  Forces and tangents mean nothing where
  /// it is not positive.  One pass, which is several times shorter than others.
  VolumeRatio SmallestVolumeRatio(const Eigen::VectorXd& displacement) const;

 private:
  /// Calls function(kind, pass, material) for each material.
  template <class Function>
  void ForEachMaterial(const Eigen::VectorXd& moduli,
                       const Function& function) const;
  /// Returns the columns that add(kind, pass, columns of the material) makes.
  template <class Adder>
  Eigen::MatrixXd SumOfColumns(const Eigen::VectorXd& moduli,
                               const Adder& add) const;

  const Mesh& mesh_;
  MaterialParameters parameters_;
  MaterialFrames frames_;
  std::vector<std::vector<Eigen::Index>> elements_of_material_;
  Dilatation dilatation_;
};

}  // namespace elastimate

#endif  // ELASTIMATE_CORE_MECHANICS_LARGE_STRAIN_FORCES_H_
