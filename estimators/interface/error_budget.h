#ifndef ELASTIMATE_ESTIMATORS_INTERFACE_ERROR_BUDGET_H_
#define ELASTIMATE_ESTIMATORS_INTERFACE_ERROR_BUDGET_H_

#include <Eigen/Core>

#include "elastimate/core/algebra/eigen_abi.h"
#include "elastimate/core/laws/elasticity.h"

namespace elastimate {

/// What one cause does to each parameter, in the order of Estimate::parameters,
/// as one standard deviation or, for causes that do not vary, as a size:
/// relative for moduli, absolute for ratios.  Not a number where unknown; empty
/// where nothing is known.
using ParameterErrors = Eigen::VectorXd;

/// The errors of an estimate by their cause; what a method does not look at is
/// unknown, and what it looked at and did not find is zero.
struct ErrorBudget {
  ParameterErrors noise;  ///< By noise alone.
  ParameterErrors bias;   ///< By the pull of noise on the method.
  ParameterErrors model;  ///< Seen in residuals that are no noise.
  /// By how much outliers pull a fit without a loss.
  ParameterErrors outliers;
  /// What the elements miss (Estimate::discretization_error).
  ParameterErrors discretization;
  /// By values far from the estimate that fit better than a parabola through
  /// the minimum says (CovarianceOfCurvature, CovarianceAcrossRange); empty
  /// where that is not looked at.
  ParameterErrors curvature;
  /// The spread of the laws that fit alike.
  ParameterErrors law;
  /// What small-strain elasticity leaves out of strains and rotations as large
  /// as those measured; empty where they are small.
  ParameterErrors kinematics;
  /// By the thickness (Section::thickness_relative_sd); empty without any.
  ParameterErrors section;
  /// By the priors (ApplyPriors); empty without any.
  ParameterErrors prior;
};

}  // namespace elastimate

#endif  // ELASTIMATE_ESTIMATORS_INTERFACE_ERROR_BUDGET_H_
