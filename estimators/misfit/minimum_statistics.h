#ifndef ELASTIMATE_ESTIMATORS_MISFIT_MINIMUM_STATISTICS_H_
#define ELASTIMATE_ESTIMATORS_MISFIT_MINIMUM_STATISTICS_H_

#include <Eigen/Core>
#include <optional>

#include "elastimate/core/scene/scene.h"
#include "elastimate/estimators/interface/estimate.h"
#include "elastimate/estimators/interface/evidence.h"
#include "elastimate/estimators/misfit/displacement_misfit.h"
#include "elastimate/estimators/misfit/mesh_error.h"
#include "elastimate/estimators/statistics/bounded_variables.h"

namespace elastimate {

/// What is known of the variables of a minimum; empty matrices where nothing.
struct MinimumErrors {
  Eigen::VectorXd variables;
  Eigen::VectorXd corrected;  ///< For what the elements miss.
  /// Covariance by independent noise, and by all that is known.  Beforehand a
  /// variable is known to 30 of the errors up to which it is determined, so
  /// that both are finite: without any data, the error is that.
  Eigen::MatrixXd of_noise;
  Eigen::MatrixXd total;
  /// The part of the total that the mesh error has; empty where none is known.
  Eigen::MatrixXd of_mesh;
  double variance = 0;       ///< The variance of the noise of a row.
  Eigen::VectorXd residual;  ///< What is left in the observed rows.
};

/// A misfit whose curvature adds to errors, and its minimum.
struct CurvedMisfit {
  DisplacementMisfit& misfit;
  const Eigen::VectorXd& minimum;
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
///   + the square of the distance to the minimum of another model of the
///     elements that explains the data about as well,
///   + what the parts above miss because the misfit is no parabola
///     (CovarianceOfCurvature, CovarianceAcrossRange).
///
/// Bounds that are given are known beforehand (FreeParameters::ErrorsByBounds);
/// that a minimum lies on one is not, so that its errors are those without it.
/// Variables that the data say nothing of have no covariance.
///
/// The last of these takes evaluations away from the minimum, of `curved`: the
/// misfit itself, or that of the same measurement in a coarser space, which
/// costs less; null leaves it out.  Else an evaluation, and O(n^2) for n points
/// in a load case (CorrelateResiduals).
///
/// `change` to the elements of the misfit from coarser ones corrects the
/// parameters that are entered for the mesh error, and adds its covariance to
/// theirs (MeshErrorOf); null where nothing is known of it.
MinimumErrors DescribeMinimum(const Scene& scene, const BoundedMinimum& found,
                              const SpaceChange* change,
                              const CurvedMisfit* curved,
                              DisplacementMisfit& misfit, Evidence& evidence,
                              Estimate& estimate);

}  // namespace elastimate

#endif  // ELASTIMATE_ESTIMATORS_MISFIT_MINIMUM_STATISTICS_H_
