#ifndef ELASTIMATE_CORE_MATERIALS_TRANSVERSELY_ISOTROPIC_LAW_H_
#define ELASTIMATE_CORE_MATERIALS_TRANSVERSELY_ISOTROPIC_LAW_H_

#include "elastimate/core/materials/kelvin_law.h"

namespace elastimate {

/// A material that is alike in all directions T across its axis L, which is
/// direction 1.
///
/// theta are the moduli of Hill [J. Mech. Phys. Solids 12 (1964) 199]
/// (n, l, k, m, p),
///
///   s_LL = n e_LL + l (e_22 + e_33),
///   (s_22 + s_33) / 2 = l e_LL + k (e_22 + e_33),
///   s_22 - s_33 = 2 m (e_22 - e_33),   s_23 = 2 m e_23,
///   s_12 = 2 p e_12,   s_13 = 2 p e_13,
///
/// of which m = G_TT = E_T / (2 (1 + nu_TT)) and p = G_LT; the others are the
/// inverse of the compliance of e_LL and (e_22 + e_33) / sqrt(2),
///
///   [n, sqrt(2) l; sqrt(2) l, 2 k]^-1 =
///   [1 / E_L, -sqrt(2) nu_LT / E_L; ., (1 - nu_TT) / E_T].
class TransverselyIsotropicLaw : public KelvinLaw {
 public:
  static constexpr std::string_view kName = "transversely_isotropic";

  TransverselyIsotropicLaw();

  std::string_view Name() const override { return kName; }
  std::string_view Description() const override;
  int NumAxes() const override { return 1; }
  Eigen::VectorXd Moduli(const Eigen::VectorXd& parameters,
                         SectionModel model) const override;
  Eigen::MatrixXd ModuliJacobian(const Eigen::VectorXd& parameters,
                                 SectionModel model) const override;
  Eigen::VectorXd ParametersOf(const Eigen::VectorXd& moduli,
                               SectionModel model) const override;
};

}  // namespace elastimate

#endif  // ELASTIMATE_CORE_MATERIALS_TRANSVERSELY_ISOTROPIC_LAW_H_
