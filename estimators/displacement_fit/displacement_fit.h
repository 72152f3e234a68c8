#ifndef ELASTIMATE_ESTIMATORS_DISPLACEMENT_FIT_DISPLACEMENT_FIT_H_
#define ELASTIMATE_ESTIMATORS_DISPLACEMENT_FIT_DISPLACEMENT_FIT_H_

#include <Eigen/Core>
#include <optional>

#include "elastimate/core/mesh/node_graph.h"
#include "elastimate/core/scene/observed_displacements.h"
#include "elastimate/core/scene/scene.h"
#include "elastimate/estimators/interface/estimate.h"
#include "elastimate/estimators/interface/estimator.h"
#include "elastimate/estimators/interface/evidence.h"
#include "elastimate/estimators/statistics/node_losses.h"

namespace elastimate {

/// A finite element model at the parameters that fit the measured
/// displacements best; residual and sensitivities in the rows of
/// ObservedDisplacements.
struct DisplacementFit {
  /// u of all nodes, num_dofs x num_load_cases.
  Eigen::MatrixXd displacement;
  Eigen::VectorXd residual;  ///< u - q.
  /// du / d (ln E, nu).
  Eigen::Matrix<double, Eigen::Dynamic, 2> sensitivities;
};

/// What a fit leaves to be done.
struct FitStatistics {
  /// The variance of a row of the residual that the standard error of nu
  /// amounts to, or would, were nu not at the end of its physical range; empty
  /// when there is none.
  std::optional<double> row_variance;
};

/// Describes a least-squares (or, with `losses`, robust) fit of the
/// displacements: fills in covariance, noise, residual statistics and
/// identifiability of `estimate`, whose elasticity is
/// set, and what there is to judge into `evidence`, whose active bounds are.
/// `graph` is that of the mesh of the scene.
///
/// Without a loss the covariance is sigma^2 (S^T S)^-1, the Cramer-Rao bound,
/// with sigma^2 as given, or from the residual; with one it is the sandwich of
/// M-estimation.  A residual that neighbouring nodes share by more than chance
/// is not noise: its smooth part may hide an error of its own size along the
/// sensitivities, and ||smooth part||^2 (S^T S)^-1 is added.  So is the square
/// of what the outliers of a fit without a loss pull the parameters by.
FitStatistics DescribeDisplacementFit(
    const Scene& scene, const NodeGraph& graph, const EstimatorOptions& options,
    const ObservedDisplacements& observed, const DisplacementFit& fit,
    const NodeLosses& losses, Evidence& evidence, Estimate& estimate);

}  // namespace elastimate

#endif  // ELASTIMATE_ESTIMATORS_DISPLACEMENT_FIT_DISPLACEMENT_FIT_H_
