#ifndef ELASTIMATE_CORE_LARGE_STRAIN_INVARIANT_LAW_H_
#define ELASTIMATE_CORE_LARGE_STRAIN_INVARIANT_LAW_H_

#include <Eigen/Core>

#include "elastimate/core/large_strain/large_strain_law.h"

namespace elastimate {

/// What an isotropic energy depends on, at some points: invariants of
/// C = F^T F, in forms that keep their digits near rest.  E = (C - I) / 2.
struct PointInvariants {
  using Row = double[PointMatrices::kPoints];
  alignas(64) Row t;      ///< tr E = (I1 - 3) / 2.
  alignas(64) Row s;      ///< (tr E)^2 - tr(E^2), so that I2 - 3 = 4 t + 2 s.
  alignas(64) Row j;      ///< J - 1, J = det F.
  alignas(64) Row log_j;  ///< ln J.
  alignas(64) Row q;      ///< J^(1/3) - 1.
  alignas(64) Row a;      ///< I1 J^(-2/3) - 3.
  alignas(64) Row b;      ///< I2 J^(-4/3) - 3.
};

/// An energy W(I1, I2, J) and its derivatives at some points.  W_J follows from
/// `rest`, which is zero at rest.
struct PointDerivatives {
  using Row = PointInvariants::Row;
  alignas(64) Row energy;  ///< W.
  alignas(64) Row w1;      ///< W_1 = dW / dI1.
  alignas(64) Row w2;      ///< W_2 = dW / dI2.
  alignas(64) Row rest;    ///< 2 W_1 + 4 W_2 + W_J.
  alignas(64) Row w11;     ///< The second derivatives; W_12 is zero.
  alignas(64) Row w22;
  alignas(64) Row w1j;
  alignas(64) Row w2j;
  alignas(64) Row wjj;
};

/// An isotropic hyperelastic law, each W_k of which is a function of I1, I2 and
/// J.  With C = F^T F, its stress is
///
///   P = 2 W_1 F + 2 W_2 (I1 F - F C) + W_J cof F
///
/// [Holzapfel, Nonlinear Solid Mechanics, 2000, section 6.2].  All three terms
/// are large at rest, where they cancel.  Therefore it is computed as
///
///   P = r I + 2 W_1 H + 4 W_2 (H + t F - F E) + W_J (tr(H) I - H^T + cof H),
///   r = 2 W_1 + 4 W_2 + W_J,
///
/// every term of which is of the size of H.  A law gives the derivatives of its
/// W_k, and the rest follows.
class InvariantLaw : public LargeStrainLaw {
 public:
  /// Sets of_moduli[k] to W_k and its derivatives at the first `count` points.
  /// All are zero before.
  virtual void DerivativesAtPoints(const PointInvariants& at, int count,
                                   PointDerivatives* of_moduli) const = 0;

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

#endif  // ELASTIMATE_CORE_LARGE_STRAIN_INVARIANT_LAW_H_
