#ifndef ELASTIMATE_ESTIMATORS_MISFIT_MINIMUM_STATISTICS_H_
#define ELASTIMATE_ESTIMATORS_MISFIT_MINIMUM_STATISTICS_H_

#include <Eigen/Core>
#include <optional>

#include "elastimate/core/scene/scene.h"
#include "elastimate/estimators/interface/estimate.h"
#include "elastimate/estimators/interface/evidence.h"
#include "elastimate/estimators/misfit/displacement_misfit.h"
#include "elastimate/estimators/misfit/finer_elements.h"

namespace elastimate {

/// What is known of the variables of a minimum; empty matrices where nothing.
struct MinimumErrors {
  Eigen::VectorXd variables;
  Eigen::VectorXd corrected;  ///< For what the elements miss.
  /// Of the change to finer elements, as far as it is expected to be there; 0
  /// where that is next to nothing.
  double share_of_finer = 0;
  double share_variance = 0;  ///< Of that share.
  /// Where a specimen would be that is as fine as those.
  Eigen::VectorXd of_finer;
  /// Covariance by independent noise, and by all that is known.  Beforehand a
  /// variable is known to 30 of the errors up to which it is determined, so
  /// that both are finite: without any data, the error is that.
  Eigen::MatrixXd of_noise;
  Eigen::MatrixXd total;
  /// Of the total, by what is not known of the change to finer elements; empty
  /// where there is none.
  Eigen::MatrixXd of_change;
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

/// The minimum of the linear model u + S d at some variables, within half of
/// the way to their bounds; empty where the stiffness is singular.
std::optional<Eigen::VectorXd> LinearMinimum(const Eigen::VectorXd& variables,
                                             DisplacementMisfit& misfit);

/// The same as DescribeMinimum of that minimum, without a look at how far the
/// misfit is from that model (CovarianceOfCurvature).
MinimumErrors DescribeLinearMinimum(const Scene& scene,
                                    const Eigen::VectorXd& variables,
                                    const Eigen::VectorXd& at_minimum,
                                    FinerElements* finer,
                                    DisplacementMisfit& misfit,
                                    Evidence& evidence, Estimate& estimate);

}  // namespace elastimate

#endif  // ELASTIMATE_ESTIMATORS_MISFIT_MINIMUM_STATISTICS_H_
