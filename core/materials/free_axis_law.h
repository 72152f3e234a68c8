#ifndef ELASTIMATE_CORE_MATERIALS_FREE_AXIS_LAW_H_
#define ELASTIMATE_CORE_MATERIALS_FREE_AXIS_LAW_H_

#include <string_view>
#include <vector>

#include "elastimate/core/materials/anisotropic_law.h"

namespace elastimate {

/// A law for a material that is alike in all directions across an axis L, where
/// L is not known but a parameter of the law.
///
/// The chart has the parameters of TransverselyIsotropicLaw, and the rotation
/// vector w = (0, w_y, w_z) [rad] which turns the direction x into the axis,
///
///   R = exp([w]_x),   L = R x,   C(p, w) = K(R) C(p) K(R)^T,
///
/// K(R) the rotation of strains in the notation of Kelvin [Mehrabadi & Cowin,
/// Q. J. Mech. Appl. Math. 43 (1990) 15].  theta are all 21 stiffnesses, as of
/// AnisotropicLaw, in the frame of the scene: stresses are linear in them.
///
/// L and -L are one axis, so that |w| <= pi / 2 has all of them; the chart is
/// regular for |w| < pi, so that no axis is at an end of it.  Where the
/// stiffness is that of an isotropic material, all w have the same theta.
class FreeAxisLaw : public AnisotropicLaw {
 public:
  static constexpr std::string_view kName = "transversely_isotropic_free_axis";

  FreeAxisLaw();

  std::string_view Name() const override { return kName; }
  std::string_view Description() const override;
  const std::vector<LawParameter>& Parameters() const override {
    return parameters_;
  }
  int NumAxes() const override { return 0; }
  /// Returns no entries: parameters, not factors, keep the stiffness positive
  /// definite.
  const std::vector<BlockEntry>& BlockEntries() const override;
  Eigen::VectorXd Moduli(const Eigen::VectorXd& parameters,
                         SectionModel model) const override;
  Eigen::MatrixXd ModuliJacobian(const Eigen::VectorXd& parameters,
                                 SectionModel model) const override;
  /// Returns the parameters of the nearest stiffness of the law, in the norm of
  /// C.
  Eigen::VectorXd ParametersOf(const Eigen::VectorXd& moduli,
                               SectionModel model) const override;

  /// Returns the parameters for which ||W (theta(p) - moduli)|| is least among
  /// positive definite stiffnesses, or NaN where no stiffness is positive
  /// definite.  As there may be several minima, a Gauss-Newton descent starts
  /// from each of 48 axes over a half sphere.  W has 21 columns.  Cost: some
  /// hundred least-squares problems with the rows of W and 7 unknowns.
  Eigen::VectorXd NearestParameters(const Eigen::VectorXd& moduli,
                                    const Eigen::MatrixXd& weights) const;

  /// Returns the parameters with |w| <= pi / 2, for the end of the same axis
  /// that is nearer to x.
  static Eigen::VectorXd WithNearerEnd(Eigen::VectorXd parameters);

  /// Returns rotation vectors w whose axes are about as far from each other all
  /// over a half sphere, by the golden angle.
  static std::vector<Eigen::Vector3d> RotationsOfHalfSphere(int num_axes);

  /// Returns the axis of these parameters, a unit vector whose first component
  /// is not negative, and (AxisJacobian) its derivative, 3 x num_parameters.
  static Eigen::Vector3d Axis(const Eigen::VectorXd& parameters);
  static Eigen::MatrixXd AxisJacobian(const Eigen::VectorXd& parameters);

  /// Returns (ln(E_L / E_T), nu_LT - nu_TT, ln(2 G_LT (1 + nu_TT) / E_T)),
  /// which is zero where the material is isotropic, and (AnisotropyJacobian)
  /// its derivative, 3 x num_parameters.
  static Eigen::Vector3d Anisotropy(const Eigen::VectorXd& parameters);
  static Eigen::MatrixXd AnisotropyJacobian(const Eigen::VectorXd& parameters);

 private:
  std::vector<LawParameter> parameters_;
};

}  // namespace elastimate

#endif  // ELASTIMATE_CORE_MATERIALS_FREE_AXIS_LAW_H_
