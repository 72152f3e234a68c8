#ifndef ELASTIMATE_CORE_MATERIALS_ANISOTROPIC_LAW_H_
#define ELASTIMATE_CORE_MATERIALS_ANISOTROPIC_LAW_H_

#include "elastimate/core/materials/kelvin_law.h"

namespace elastimate {

/// A material of no symmetry: theta and its parameters are the 21 stiffnesses
/// c_11, c_12, ..., c_16, c_22, ..., c_66 in the notation of Voigt,
///
///   (s_11, s_22, s_33, s_23, s_13, s_12) =
///       c (e_11, e_22, e_33, 2 e_23, 2 e_13, 2 e_12)
///
/// [Ting, Anisotropic Elasticity (1996), eq. 2.3-1].
class AnisotropicLaw : public KelvinLaw {
 public:
  static constexpr std::string_view kName = "anisotropic";

  AnisotropicLaw();

  std::string_view Name() const override { return kName; }
  std::string_view Description() const override;
  int NumAxes() const override { return 2; }
  bool HasAxesOfScene() const override { return true; }
  Eigen::VectorXd Moduli(const Eigen::VectorXd& parameters,
                         SectionModel model) const override;
  Eigen::MatrixXd ModuliJacobian(const Eigen::VectorXd& parameters,
                                 SectionModel model) const override;
  Eigen::VectorXd ParametersOf(const Eigen::VectorXd& moduli,
                               SectionModel model) const override;
};

}  // namespace elastimate

#endif  // ELASTIMATE_CORE_MATERIALS_ANISOTROPIC_LAW_H_
