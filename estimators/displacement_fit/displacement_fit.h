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

/// What it does to (ln E, nu) that supports end somewhere within elements.
struct SupportDoubt {
  Eigen::Vector2d correction = Eigen::Vector2d::Zero();  ///< To be added.
  Eigen::Matrix2d covariance = Eigen::Matrix2d::Zero();
};

/// A finite element model at the parameters that fit the measured
/// displacements best; residual and sensitivities in the rows of
/// ObservedDisplacements.
struct DisplacementFit {
  /// u of all nodes, num_dofs x num_load_cases.
  Eigen::MatrixXd displacement;
  /// u - q, of q without what was taken from it.
  Eigen::VectorXd residual;
  /// du / d (ln E, nu).
  Eigen::Matrix<double, Eigen::Dynamic, 2> sensitivities;
  /// That of ElementChange in u; empty where it is not known.
  std::optional<Eigen::VectorXd> element_change;
  /// The part of such a change that was taken from the measurement before it
  /// was fitted; empty where nothing.
  Eigen::VectorXd taken;
  SupportDoubt supports;
};

/// What a fit leaves to be done.
struct FitStatistics {
  /// The variance of a row of the residual that the standard error of nu
  /// amounts to, or would, were nu not at the end of its physical range; empty
  /// when there is none.
  std::optional<double> row_variance;
  /// Of the change to finer elements, as far as it is expected to be there.
  double share_of_finer = 0;
  /// Of (ln E, nu), for what finer elements explain of the residual.
  Eigen::Vector2d correction = Eigen::Vector2d::Zero();
  /// How much more than the least the square sum may be of a fit that becomes
  /// the best once that change is taken from the measurement.
  double excess_of_finer = 0;
  /// BoundedNorm of the residual that is left; empty where there is too little
  /// to describe the fit by.
  std::optional<double> rest;
};

/// With another (ln E, nu); nu moves half of the way to a limit at most.
IsotropicElasticity Corrected(const IsotropicElasticity& elasticity,
                              const Eigen::Vector2d& correction);

/// Corrects (ln E, nu) of a usable estimate for what the elements miss and for
/// where supports end, as DescribeDisplacementFit found it, with the interval
/// of nu, which then holds what they leave uncertain as well.  `uncorrected`
/// are those of a fit to the measurement as it is.
void CorrectForElements(const Evidence& evidence,
                        const IsotropicElasticity& uncorrected,
                        Estimate& estimate);

/// Describes a least-squares (or, with `losses`, robust) fit of the
/// displacements: fills in covariance, noise, residual statistics,
/// discretisation error and identifiability of `estimate`, whose elasticity is
/// set, and what there is to judge into `evidence`, whose active bounds are.
/// `graph` is that of the mesh of the scene.
///
/// Without a loss the covariance is sigma^2 (S^T S)^-1, the Cramer-Rao bound,
/// with sigma^2 as given, or from the residual; with one it is the sandwich of
/// M-estimation.  A residual that neighbouring nodes share by more than chance
/// is not noise: its smooth part may hide an error of its own size along the
/// sensitivities, and ||smooth part||^2 (S^T S)^-1 is added.  So is the square
/// of what the outliers of a fit without a loss pull the parameters by, and
/// what the elements (ElementErrors) and the ends of supports within them leave
/// uncertain.
FitStatistics DescribeDisplacementFit(
    const Scene& scene, const NodeGraph& graph, const EstimatorOptions& options,
    const ObservedDisplacements& observed, const DisplacementFit& fit,
    const NodeLosses& losses, Evidence& evidence, Estimate& estimate);

}  // namespace elastimate

#endif  // ELASTIMATE_ESTIMATORS_DISPLACEMENT_FIT_DISPLACEMENT_FIT_H_
