#ifndef ELASTIMATE_CORE_MATERIALS_GREEN_STRAIN_LAW_H_
#define ELASTIMATE_CORE_MATERIALS_GREEN_STRAIN_LAW_H_

#include <memory>
#include <string>
#include <vector>

#include "elastimate/core/large_strain/large_strain_law.h"

namespace elastimate {

/// The law of St. Venant and Kirchhoff of a material that is not alike in all
/// directions: a law of small strains between Green's strain
/// E = (F^T F - I) / 2 and the second Piola-Kirchhoff stress S,
///
///   W_k = W_k(small strains; E),   S_k = C_k : E,   P_k = F S_k
///
/// [Holzapfel, Nonlinear Solid Mechanics, 2000, section 6.5].  Parameters,
/// moduli and axes are those of the law of small strains.  The axes are
/// directions of the undeformed specimen, which turn and stretch with it.
///
/// Its name is that of the law of small strains behind "st_venant_kirchhoff_".
/// Laws of solids whose axes are given take part; one whose axis is unknown
/// would need its own chart.
class GreenStrainLaw : public LargeStrainLaw {
 public:
  /// Precondition: a law of small strains of solids.
  explicit GreenStrainLaw(std::unique_ptr<const Law> small_strains);

  std::string_view Name() const override { return name_; }
  std::string_view Description() const override { return description_; }
  bool Takes(SectionModel model) const override {
    return model == SectionModel::kSolid;
  }
  const std::vector<LawParameter>& Parameters() const override {
    return law_->Parameters();
  }
  int NumModuli() const override { return law_->NumModuli(); }
  int NumAxes() const override { return law_->NumAxes(); }
  bool HasAxesOfScene() const override { return law_->HasAxesOfScene(); }
  const std::vector<BlockEntry>& BlockEntries() const override {
    return law_->BlockEntries();
  }
  Eigen::VectorXd Moduli(const Eigen::VectorXd& parameters,
                         SectionModel model) const override {
    return law_->Moduli(parameters, model);
  }
  Eigen::MatrixXd ModuliJacobian(const Eigen::VectorXd& parameters,
                                 SectionModel model) const override {
    return law_->ModuliJacobian(parameters, model);
  }
  Eigen::VectorXd ParametersOf(const Eigen::VectorXd& moduli,
                               SectionModel model) const override {
    return law_->ParametersOf(moduli, model);
  }

  Eigen::VectorXd Energies(const Eigen::MatrixXd& gradient,
                           SectionModel model) const override;
  void StressesAtPoints(const PointMatrices& gradients, GradientEntries entries,
                        int count, PointMatrices* columns) const override;
  void TangentsAtPoints(const Eigen::VectorXd& moduli,
                        const PointMatrices& gradients, GradientEntries entries,
                        int count, PointTangents& tangents,
                        PointMatrices* stresses) const override;

 private:
  using Matrix9 = Eigen::Matrix<double, 9, 9>;

  std::unique_ptr<const Law> law_;
  std::string name_;
  std::string description_;
  std::vector<Matrix9> stiffnesses_;  ///< C_k.
};

}  // namespace elastimate

#endif  // ELASTIMATE_CORE_MATERIALS_GREEN_STRAIN_LAW_H_
