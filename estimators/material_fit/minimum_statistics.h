#ifndef ELASTIMATE_ESTIMATORS_MATERIAL_FIT_MINIMUM_STATISTICS_H_
#define ELASTIMATE_ESTIMATORS_MATERIAL_FIT_MINIMUM_STATISTICS_H_

#include <Eigen/Core>

#include "elastimate/core/scene/scene.h"
#include "elastimate/estimators/interface/estimate.h"
#include "elastimate/estimators/interface/evidence.h"
#include "elastimate/estimators/material_fit/displacement_misfit.h"
#include "elastimate/estimators/material_fit/finer_elements.h"

namespace elastimate {

/// What is known of the variables of a minimum; empty matrices where nothing.
struct MinimumErrors {
  Eigen::VectorXd variables;
  Eigen::VectorXd corrected;  ///< For what the elements miss.
  /// Of the change to finer elements, as far as it is expected to be there; 0
  /// where that is next to nothing.
  double share_of_finer = 0;
  /// Where a specimen would be that is as fine as those.
  Eigen::VectorXd of_finer;
  /// Covariance by independent noise, and by all that is known.  Beforehand a
  /// variable is known to 30 of the errors up to which it is determined, so
  /// that both are finite: without any data, the error is that.
  Eigen::MatrixXd of_noise;
  Eigen::MatrixXd total;
  double variance = 0;  ///< Of noise in a row.
  /// Of the observed rows, without what finer elements explain.
  Eigen::VectorXd residual;
};

/// Enters the noise and the covariance of a minimum into the estimate, whose
/// parameters are entered, and what there is to judge into the evidence:
///
///   sigma^2 (S^T S)^-1, the Cramer-Rao bound, with sigma^2 as given or from
///     the residual,
///   + what correlated residuals add to it (DescribeCorrelation),
///   + (S^T S)^-1 times the square sum of a residual that is alike over the
///     specimen, which no noise is,
///   + the square of what outliers that are left pull the parameters by,
///   + the square of what a rotation of given axes would change, as far as the
///     residual asks for it by more than chance (FindAxisRotation),
///   + what the first two understate far from the minimum
///     (CovarianceOfCurvature).
///
/// Variables that the data say nothing of have no covariance.
///
/// An evaluation, and O(n^2) for n points in a load case (CorrelateResiduals).
///
/// `finer` may be null.  What of the change of the rows to finer elements the
/// residual shows corrects the parameters that are entered, and its error is
/// part of theirs (ElementErrors); so is the step that is left to the minimum
/// of the finer elements where the correction leads, which is zero where the
/// change is that of a linear model.
MinimumErrors DescribeMinimum(const Scene& scene,
                              const Eigen::VectorXd& variables,
                              FinerElements* finer, DisplacementMisfit& misfit,
                              Evidence& evidence, Estimate& estimate);

}  // namespace elastimate

#endif  // ELASTIMATE_ESTIMATORS_MATERIAL_FIT_MINIMUM_STATISTICS_H_
