#ifndef ELASTIMATE_CORE_LAWS_ELASTICITY_H_
#define ELASTIMATE_CORE_LAWS_ELASTICITY_H_

#include <Eigen/Core>

#include "elastimate/core/mesh/mesh.h"

namespace elastimate {

/// Isotropic linear elasticity.  The only place where its parameters are
/// converted.
///
/// The stiffness of a solid, plane strain or plane stress section is
/// K = s (H + nu J) with matrices H and J of the mesh alone, which are made of
/// e = sym(grad u) as
///
///   H u: integral of e grad(N_i),
///   J u: integral of (tr(e) I - c e) grad(N_i),   c = 2, in plane stress 1.
///
/// Physical values are E > 0 and -1 < nu < 1/2; the conversions are plain
/// formulas and accept any numbers, so that an unphysical estimate can be
/// reported in every form (a division by zero gives an infinity, as IEEE says).
struct IsotropicElasticity {
  double youngs_modulus;  ///< E [pressure].
  double poisson_ratio;   ///< nu [-].

  /// E of the compliance scale t = 1 / s of K = s (H + nu J).
  static IsotropicElasticity FromComplianceScale(double compliance_scale,
                                                 double poisson_ratio,
                                                 SectionModel model);

  /// (E, nu), as the isotropic law has them.
  Eigen::Vector2d Parameters() const { return {youngs_modulus, poisson_ratio}; }
  /// mu = E / (2 (1 + nu)).
  double ShearModulus() const;
  /// lambda = E nu / ((1 + nu)(1 - 2 nu)).
  double LameLambda() const;
  /// kappa = E / (3 (1 - 2 nu)).
  double BulkModulus() const;
  /// 1 / kappa = 3 (1 - 2 nu) / E, which is well determined near nu = 1/2 where
  /// kappa is not.
  double BulkCompliance() const;
  /// s = E / ((1 + nu)(1 - 2 nu)), the factor of K = s (H + nu J) [Becker &
  /// Teschner 2007, eq. 14-22]; in plane stress E / (1 - nu^2).
  double StiffnessScale(SectionModel model) const;
  /// t = 1 / s.
  double ComplianceScale(SectionModel model) const;

  /// E > 0 and -1 < nu < 1/2 (NaN is not physical).
  bool IsPhysical() const;
};

/// The range of Poisson's ratio that a bounded fit searches: at -1 and 1/2 the
/// stiffness is singular or infinite.
constexpr double kSmallestPoissonRatio = -0.9999;
constexpr double kLargestPoissonRatio = 0.49999;

/// c of J.
constexpr double ShearShareOfJ(SectionModel model) {
  return model == SectionModel::kPlaneStress ? 1 : 2;
}

/// Returns E t = (1 + nu)(1 - 2 nu), in plane stress (1 + nu)(1 - nu).
template <typename T>
T ComplianceFactor(const T& poisson_ratio, SectionModel model) {
  const double c = ShearShareOfJ(model);
  return (1.0 + poisson_ratio) * (1.0 - c * poisson_ratio);
}

/// Returns d (E t) / d nu.
[[nodiscard]] double ComplianceFactorSlope(double poisson_ratio,
                                           SectionModel model);

/// Returns d ln E / d nu among materials of the same compliance scale t.
[[nodiscard]] double LogYoungsModulusSlope(double poisson_ratio,
                                           SectionModel model);

/// Returns ln((1 + nu) / (1 - 2 nu)) = ln(3 kappa / (2 mu)), the scale on which
/// the stiffness changes evenly over the whole range of nu.
[[nodiscard]] double LogStiffnessRatio(double poisson_ratio);

/// Returns d nu / d LogStiffnessRatio at this nu.
[[nodiscard]] inline double PoissonRatioSlope(double poisson_ratio) {
  return (1 + poisson_ratio) * (1 - 2 * poisson_ratio) / 3;
}

/// Returns the nu that has this LogStiffnessRatio.
[[nodiscard]] double PoissonRatioOfLogStiffnessRatio(
    double log_stiffness_ratio);

/// d (mu, 1 / kappa) / d (E, nu): rows (mu, 1 / kappa), columns (E, nu).
[[nodiscard]] Eigen::Matrix2d ShearAndBulkJacobian(
    const IsotropicElasticity& elasticity);

}  // namespace elastimate

#endif  // ELASTIMATE_CORE_LAWS_ELASTICITY_H_
