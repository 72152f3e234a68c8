#ifndef ELASTIMATE_ESTIMATORS_INTERFACE_LIMITS_H_
#define ELASTIMATE_ESTIMATORS_INTERFACE_LIMITS_H_

#include <Eigen/Core>

namespace elastimate {

/// Standard deviations of a normal distribution that hold 95 % of it, on both
/// sides and on one.
inline constexpr double kTwoSidedErrors = 1.960;
inline constexpr double kOneSidedErrors = 1.645;

/// Where a number of an estimate becomes a finding or a status.  All of them
/// stand here, and nowhere else; tolerances of algorithms (rounding,
/// collinearity, convergence) stand with these.
struct Limits {
  // What chance explains.

  /// In standard deviations: beyond, independent noise is no explanation.  Few
  /// enough estimates are made for one in three million to be none.
  double significant_score = 5;
  /// In standard deviations: a correlation of neighbours counts as far as it is
  /// beyond.  Independent noise is, in one measurement of 700, and then a
  /// little.
  double explained_score = 3;
  /// Probability below which resultants contradict a fit.
  double resultant_significance = 1e-3;
  /// Probability below which a fit with other axes is better.
  double axis_significance = 1e-3;
  /// Root mean square of the residuals over their robust standard deviation,
  /// from which on outliers are looked for: 1 for Gaussian noise, 1.4 for
  /// Laplacian.
  double heavy_tails = 1.2;
  /// Force residual over what the given noise explains: it is of so many rows
  /// that any excess is significant, and noise that is not white gives some.
  double excess_force_residual = 1.5;
  /// Rows without those that fix the parameters, below which the noise is not
  /// estimated: the variance of Student's t is infinite.
  Eigen::Index least_redundancy = 3;

  // What a user wants to be told of.

  /// Relative error of E, and of the loads that it scales with.
  double notable_youngs_modulus_error = 0.01;
  /// Error of nu [1].
  double notable_poisson_ratio_error = 0.01;
  /// Discretisation error in standard errors: below, it does not show.
  double notable_discretization_share = 0.5;
  /// Motion of held nodes over that of the free ones (root of the square
  /// sums): noise of measured supports is less.
  double held_motion = 0.1;
  /// Force residual over the load, below which noise need not be told from a
  /// wrong model: neither can put E off by more.
  double small_force_residual = 0.1;

  // What is not usable.

  /// Relative error of E that no standard error can stand for: bias of the
  /// method, loads out of balance, what a bound or a given nu changes.
  double unusable_error = 0.1;
  /// Bias of nu [1]; it changes a bulk modulus at nu = 0.3 by 15 %.
  double unusable_poisson_ratio_bias = 0.03;
  /// Displacement residual, smooth part of it, or correction of the
  /// displacements that balances the loads, over the measured displacements:
  /// larger ones say that the model is another one than that of the experiment.
  double large_residual = 0.2;
  /// A standard error of nu above this says that the data do not determine nu:
  /// its whole range for common materials is 0 to 0.5 [1].
  double largest_poisson_ratio_error = 0.15;
  /// A standard error of the direction of an axis above this [rad] says that
  /// the data do not determine it; its scale is a right angle.
  double largest_axis_error = 0.15;
  /// Where chi^2 of the best fit with another axis is larger by less than this,
  /// the data do not determine the axis: by noise, the wrong one of two is so
  /// far ahead in about one scene of a hundred.
  double least_axis_preference = 9;
  /// A distance from isotropy below this (chi^2 with 3 degrees of freedom,
  /// about the one of all axes where chance makes it largest) says that there
  /// is none, however small the error about a minimum that noise made is.
  double least_anisotropy = 30;
  /// A relative standard error of E above this says that the data do not
  /// determine E: zero and infinity are within three standard errors.
  double largest_youngs_modulus_error = 1.0 / 3;

  // What small-strain elasticity leaves out.

  /// Root mean square strain, and rotation [rad, 3 degrees], below which nobody
  /// mentions it.
  double mentioned_strain = 0.01;
  double mentioned_rotation = 0.0524;
  /// A strain beyond this is that of rubber, which keeps its volume, or another
  /// unit of length.
  double doubtful_strain = 1;
  double volume_change_of_rubber = 2;
  /// No specimen has a strain beyond this; rubber breaks before.
  double impossible_strain = 10;

  // What is called exact.

  /// A displacement or force residual that is rounding alone.
  double exact_residual = 1e-6;
};

inline constexpr Limits kLimits{};

}  // namespace elastimate

#endif  // ELASTIMATE_ESTIMATORS_INTERFACE_LIMITS_H_
