#ifndef ELASTIMATE_CORE_MATERIALS_ISOTROPIC_LAW_H_
#define ELASTIMATE_CORE_MATERIALS_ISOTROPIC_LAW_H_

#include <vector>

#include "elastimate/core/laws/law.h"
#include "elastimate/core/materials/material.h"

namespace elastimate {

/// Isotropic elasticity of small strains, e = sym(H):
///
///   P_1 = e,   P_2 = tr(e) I - c e,   theta = (s, s nu),
///
/// with the c and s of IsotropicElasticity, so that the columns of the forces
/// are H q and J q.  W_1 = e:e / 2, W_2 = (tr(e)^2 - c e:e) / 2.
class IsotropicLaw : public Law {
 public:
  static constexpr std::string_view kName = "isotropic";

  std::string_view Name() const override { return kName; }
  std::string_view Description() const override;
  const std::vector<LawParameter>& Parameters() const override;
  int NumModuli() const override { return 2; }
  bool Takes(SectionModel model) const override;
  Eigen::VectorXd Energies(const Eigen::MatrixXd& gradient,
                           SectionModel model) const override;
  Eigen::MatrixXd Stresses(const Eigen::MatrixXd& gradient,
                           SectionModel model) const override;
  Eigen::MatrixXd Tangent(const Eigen::VectorXd& moduli,
                          const Eigen::MatrixXd& gradient,
                          SectionModel model) const override;
  Eigen::VectorXd Moduli(const Eigen::VectorXd& parameters,
                         SectionModel model) const override;
  Eigen::MatrixXd ModuliJacobian(const Eigen::VectorXd& parameters,
                                 SectionModel model) const override;
  Eigen::VectorXd ParametersOf(const Eigen::VectorXd& moduli,
                               SectionModel model) const override;
};

/// Tells whether all materials have that law, as an empty list has.
[[nodiscard]] bool AreIsotropic(const std::vector<Material>& materials);

}  // namespace elastimate

#endif  // ELASTIMATE_CORE_MATERIALS_ISOTROPIC_LAW_H_
