#ifndef ELASTIMATE_CORE_MATERIALS_KELVIN_LAW_H_
#define ELASTIMATE_CORE_MATERIALS_KELVIN_LAW_H_

#include <vector>

#include "elastimate/core/laws/law.h"

namespace elastimate {

/// Elasticity of small strains of any symmetry, in the notation of Kelvin,
///
///   e = (e_11, e_22, e_33, sqrt(2) e_23, sqrt(2) e_13, sqrt(2) e_12), in the
///   plane (e_11, e_22, sqrt(2) e_12),   e = sym(H),
///   s = C e,   C = sum_k theta_k B_k,   W_k = e . B_k e / 2,
///
/// in which stresses and strains are vectors, and the stiffness C a tensor
/// [Mehrabadi & Cowin, Q. J. Mech. Appl. Math. 43 (1990) 15].  A law is a list
/// of modes, sets of unit strains v_a that are alike, and of the entry of each
/// modulus on these, which is
///
///   B_k = factor sum of sym(v_row v_column^T) over the strains of the modes.
class KelvinLaw : public Law {
 public:
  const std::vector<LawParameter>& Parameters() const override {
    return parameters_;
  }
  int NumModuli() const override { return static_cast<int>(entries_.size()); }
  bool Takes(SectionModel model) const override { return model == model_; }
  const std::vector<BlockEntry>& BlockEntries() const override {
    return entries_;
  }
  Eigen::VectorXd Energies(const Eigen::MatrixXd& gradient,
                           SectionModel model) const override;
  Eigen::MatrixXd Stresses(const Eigen::MatrixXd& gradient,
                           SectionModel model) const override;
  Eigen::MatrixXd Tangent(const Eigen::VectorXd& moduli,
                          const Eigen::MatrixXd& gradient,
                          SectionModel model) const override;

 protected:
  /// Each mode has its strains as columns, 6 rows in space, 3 in the plane.
  KelvinLaw(SectionModel model, std::vector<LawParameter> parameters,
            const std::vector<Eigen::MatrixXd>& modes,
            std::vector<BlockEntry> entries);

 private:
  SectionModel model_;
  std::vector<LawParameter> parameters_;
  std::vector<BlockEntry> entries_;
  std::vector<Eigen::MatrixXd> bases_;
};

/// Returns modes of which each is one component of strain.
std::vector<Eigen::MatrixXd> ComponentModes(int num_components);

/// The strain of a gradient in the notation of Kelvin is this matrix times the
/// gradient: 6 x 9 in three dimensions, 3 x 4 in two.
Eigen::MatrixXd KelvinStrainOfGradient(Eigen::Index dimension);

/// Returns the stiffness c_ij in the notation of Voigt, s = c e with shears 2
/// e_23, 2 e_13 and 2 e_12, for a tangent of small strains: 6 x 6, in the plane
/// 3 x 3.
Eigen::MatrixXd VoigtStiffness(const Eigen::MatrixXd& tangent);

}  // namespace elastimate

#endif  // ELASTIMATE_CORE_MATERIALS_KELVIN_LAW_H_
