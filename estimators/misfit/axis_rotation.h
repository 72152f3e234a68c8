#ifndef ELASTIMATE_ESTIMATORS_MISFIT_AXIS_ROTATION_H_
#define ELASTIMATE_ESTIMATORS_MISFIT_AXIS_ROTATION_H_

#include <Eigen/Core>
#include <optional>

#include "elastimate/core/scene/scene.h"
#include "elastimate/estimators/misfit/displacement_misfit.h"

namespace elastimate {

/// What the residual of a fit says of axes that were given.
struct AxisRotation {
  /// By how much the axes of the material whose rotation is the least likely
  /// by chance should be turned [rad], and the place of that.
  double angle = 0;
  std::size_t material = 0;
  /// What the rotations of all materials would explain, in variances of the
  /// noise, and how many of them there are: chi^2 of as many degrees of freedom
  /// where all axes are right.
  double chi_square;
  Eigen::Index num_rotations;
  /// How the variables change with those rotations.
  Eigen::VectorXd change;

  /// The share of the square of the change that right axes do not explain, from
  /// three times the expected chi^2 on.
  double BeyondChance() const;
  /// The probability of so large a chi^2 where all axes are right.
  double Probability() const;
};

/// The rotations w of the axes of all materials that have some which were
/// given, by a Gauss-Newton step of them and of the variables together:
///
///   R = d rows / d w = -K^-1 (dK / dw) u,   R' = R - S C S^T R,
///   w = -(R'^T R')^+ R'^T r,   change = -C S^T R w,
///   chi^2 = r^T R' (R'^T R')^+ R'^T r / variance of a row,
///
/// a score test [Rao 1948], which needs no other fit.  A rotation that changes
/// nothing, such as that of one axis about itself, is none.
///
/// `rows` are r, what is left of the observed rows at the variables,
/// `sensitivities` S there and `inverse` C = (S^T S)^-1; `given_variance` of a
/// row, where it is known.
///
/// Empty where there are no such axes, and where motions are unknown.  Two
/// element passes and a solve for each load case and rotation, of which a
/// material has three, or one in the plane; a factorisation where the model is
/// not at x.
std::optional<AxisRotation> FindAxisRotation(
    const Scene& scene, const Eigen::VectorXd& x, const Eigen::VectorXd& rows,
    const Eigen::MatrixXd& sensitivities, const Eigen::MatrixXd& inverse,
    const std::optional<double>& given_variance, DisplacementMisfit& misfit);

}  // namespace elastimate

#endif  // ELASTIMATE_ESTIMATORS_MISFIT_AXIS_ROTATION_H_
