#ifndef ELASTIMATE_CORE_MATERIALS_ORTHOTROPIC_LAW_H_
#define ELASTIMATE_CORE_MATERIALS_ORTHOTROPIC_LAW_H_

#include "elastimate/core/materials/kelvin_law.h"

namespace elastimate {

/// A material with three planes of symmetry, normal to its directions 1, 2 and
/// 3; in plane stress the lamina of a laminate, with directions 1 and 2.
///
/// theta are the stiffnesses (c_11, c_12, c_13, c_22, c_23, c_33, c_44, c_55,
/// c_66), of a lamina the reduced ones (Q_11, Q_12, Q_22, Q_66).  Those of
/// normal strains are the inverse of the compliance, which the chart has as
///
///   S_ii = 1 / E_i,   S_ij = -nu_ij / E_i = -nu_ji / E_j  (i < j),
///
/// and those of shears are G_23, G_13 and G_12 [Jones, Mechanics of Composite
/// Materials (1999), eq. 2.24-2.26, 2.66].
class OrthotropicLaw : public KelvinLaw {
 public:
  static constexpr std::string_view kName = "orthotropic";

  /// `model` is kSolid or kPlaneStress.
  explicit OrthotropicLaw(SectionModel model);

  std::string_view Name() const override { return kName; }
  std::string_view Description() const override;
  int NumAxes() const override { return num_directions_ - 1; }
  Eigen::VectorXd Moduli(const Eigen::VectorXd& parameters,
                         SectionModel model) const override;
  Eigen::MatrixXd ModuliJacobian(const Eigen::VectorXd& parameters,
                                 SectionModel model) const override;
  Eigen::VectorXd ParametersOf(const Eigen::VectorXd& moduli,
                               SectionModel model) const override;

 private:
  Eigen::MatrixXd NormalCompliance(const Eigen::VectorXd& parameters) const;

  int num_directions_;
};

}  // namespace elastimate

#endif  // ELASTIMATE_CORE_MATERIALS_ORTHOTROPIC_LAW_H_
