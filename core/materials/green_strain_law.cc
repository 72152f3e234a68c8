#include "elastimate/core/materials/green_strain_law.h"

#include <utility>

namespace elastimate {
namespace {

using Vector9 = Eigen::Matrix<double, 9, 1>;

constexpr SectionModel kSolid = SectionModel::kSolid;

Eigen::Matrix3d GradientAt(const PointMatrices& gradients, int point) {
  Eigen::Matrix3d gradient;
  for (int i = 0; i < 9; ++i) {
    gradient(i) = gradients.row[i][point];
  }
  return gradient;
}

// Returns E without forming F, so that it keeps its digits near rest.
Eigen::Matrix3d StrainOf(const Eigen::Matrix3d& gradient) {
  return (gradient + gradient.transpose() + gradient.transpose() * gradient) /
         2;
}

}  // namespace

GreenStrainLaw::GreenStrainLaw(std::unique_ptr<const Law> small_strains)
    : law_(std::move(small_strains)),
      name_("st_venant_kirchhoff_" + std::string(law_->Name())),
      description_("large rotations: " + std::string(law_->Name()) +
                   " in Green's strain") {
  const int num_moduli = law_->NumModuli();
  for (int k = 0; k < num_moduli; ++k) {
    stiffnesses_.emplace_back(law_->Tangent(
        Eigen::VectorXd::Unit(num_moduli, k), Eigen::Matrix3d::Zero(), kSolid));
  }
}

Eigen::VectorXd GreenStrainLaw::Energies(const Eigen::MatrixXd& gradient,
                                         SectionModel /*model*/) const {
  return law_->Energies(StrainOf(gradient), kSolid);
}

void GreenStrainLaw::StressesAtPoints(const PointMatrices& gradients,
                                      GradientEntries /*entries*/, int count,
                                      PointMatrices* columns) const {
  for (int p = 0; p < count; ++p) {
    const Eigen::Matrix3d h = GradientAt(gradients, p);
    const Eigen::Matrix3d strain = StrainOf(h);
    for (int k = 0; k < NumModuli(); ++k) {
      const Vector9 of_strain = stiffnesses_[k] * strain.reshaped();
      const Eigen::Map<const Eigen::Matrix3d> s(of_strain.data());
      const Eigen::Matrix3d stress = s + h * s;
      for (int i = 0; i < 9; ++i) {
        columns[k].row[i][p] = stress(i);
      }
    }
  }
}

void GreenStrainLaw::TangentsAtPoints(const Eigen::VectorXd& moduli,
                                      const PointMatrices& gradients,
                                      GradientEntries /*entries*/, int count,
                                      PointTangents& tangents,
                                      PointMatrices* stresses) const {
  Matrix9 stiffness = Matrix9::Zero();
  for (int k = 0; k < NumModuli(); ++k) {
    stiffness += moduli(k) * stiffnesses_[k];
  }
  // dP = dH S + F C : (F^T dH), where C takes the symmetric part of F^T dH.
  for (int p = 0; p < count; ++p) {
    Eigen::Matrix3d f = GradientAt(gradients, p);  // H, until I is added.
    const Vector9 s = stiffness * StrainOf(f).reshaped();
    if (stresses != nullptr) {
      const Eigen::Map<const Eigen::Matrix3d> second(s.data());
      const Eigen::Matrix3d stress = second + f * second;
      for (int i = 0; i < 9; ++i) {
        stresses->row[i][p] = stress(i);
      }
    }
    f.diagonal().array() += 1;
    for (Eigen::Index i = 0; i < 3; ++i) {
      for (Eigen::Index j = 0; j <= i; ++j) {
        Eigen::Matrix3d block =
            f * stiffness.block<3, 3>(3 * i, 3 * j) * f.transpose();
        block.diagonal().array() += s(i + 3 * j);
        for (Eigen::Index b = 0; b < 3; ++b) {
          for (Eigen::Index a = i == j ? b : 0; a < 3; ++a) {
            tangents.row[TangentRow(int(a + 3 * i), int(b + 3 * j))][p] =
                block(a, b);
          }
        }
      }
    }
  }
}

}  // namespace elastimate
