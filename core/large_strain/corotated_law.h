#ifndef ELASTIMATE_CORE_LARGE_STRAIN_COROTATED_LAW_H_
#define ELASTIMATE_CORE_LARGE_STRAIN_COROTATED_LAW_H_

#include "elastimate/core/large_strain/charts.h"
#include "elastimate/core/large_strain/large_strain_law.h"

namespace elastimate {

/// Hooke's law in the frame that turns with the material.  With the polar
/// decomposition F = R U,
///
///   W = mu |U - I|^2 + lambda / 2 (tr U - 3)^2,
///   P = 2 mu (F - R) + lambda (tr U - 3) R
///
/// [Müller & Gross, Graphics Interface 2004; Chao et al., ACM Trans. Graphics
/// 29(4), 2010].  The moduli are (mu, lambda).
///
/// R comes from Newton's iteration R <- (R + R^-T) / 2 from R = F [Higham, SIAM
/// J. Sci. Stat. Comput. 7 (1986) 1160], and F - R = R (U - I) from
/// (U - I) (U + I) = 2 E, which keeps its digits near rest.
class CorotatedLaw : public LameLaw<LargeStrainLaw> {
 public:
  std::string_view Name() const override { return "corotated"; }
  std::string_view Description() const override;
  Eigen::VectorXd Energies(const Eigen::MatrixXd& gradient,
                           SectionModel model) const override;
  void StressesAtPoints(const PointMatrices& gradients, GradientEntries entries,
                        int count, PointMatrices* columns) const override;
  void TangentsAtPoints(const Eigen::VectorXd& moduli,
                        const PointMatrices& gradients, GradientEntries entries,
                        int count, PointTangents& tangents,
                        PointMatrices* stresses) const override;
};

}  // namespace elastimate

#endif  // ELASTIMATE_CORE_LARGE_STRAIN_COROTATED_LAW_H_
