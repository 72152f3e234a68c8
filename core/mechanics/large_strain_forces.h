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

/// How an element evaluates its change of volume.
enum class Dilatation {
  kOfPoints,  ///< J = det F at each point of the integration.
  /// Linear hexahedra, and linear quadrilaterals in plane strain, use the mean
  /// of J over the element.  Quadratic ones use the least-squares fit of J by a
  /// linear function over the element.  These elements do not lock if the
  /// material is nearly incompressible.  Other elements use J at each point.
  kMeanOfElement,
};

/// The change of volume at a place of the mesh.
struct VolumeRatio {
  double value;          ///< det F; in a planar mesh, that in the plane.
  Eigen::Index element;  ///< The element of this place.
};

/// Returns the smallest det F of a mesh at a displacement (num_dofs), over the
/// points of the integration, and its element.  Laws of large strains have no
/// forces unless it is positive.  One pass.
[[nodiscard]] VolumeRatio SmallestVolumeRatio(
    const Mesh& mesh, const Eigen::VectorXd& displacement);

/// The internal forces of a mesh of some materials at a displacement u of any
/// size.  They are linear in the moduli,
///
///   f(u; theta) = sum_k theta_k f_k(u),
///   f_k(u)_i = integral of P_k(grad u) grad(N_i) over the material of k,
///
/// over the undeformed mesh, and their tangent K = df / du is symmetric.
///
/// With the mean dilatation Theta = (integral of J) / V of an element, or its
/// linear fit, laws are evaluated at Fbar = (Theta / J)^(1/3) F in place of F,
/// and forces are the derivatives of that energy.  This is the three-field
/// method with constant (linear) pressure and volume [Simo, Taylor & Pister,
/// Comput. Methods Appl. Mech. Eng. 51 (1985) 177], after pressure and volume
/// are eliminated in each element.
///
/// In plane stress, the stretch across the plate depends on the moduli.
/// Columns f_k are evaluated at the stretch of the given moduli, so they are
/// not the derivatives of f with respect to the moduli (ModuliDerivatives).
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

  /// Does so for the mesh, in a fraction of the time of the other passes.
  VolumeRatio SmallestVolumeRatio(const Eigen::VectorXd& displacement) const {
    return elastimate::SmallestVolumeRatio(mesh_, displacement);
  }

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
