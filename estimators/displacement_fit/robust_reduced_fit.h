#ifndef ELASTIMATE_ESTIMATORS_DISPLACEMENT_FIT_ROBUST_REDUCED_FIT_H_
#define ELASTIMATE_ESTIMATORS_DISPLACEMENT_FIT_ROBUST_REDUCED_FIT_H_

#include <Eigen/Core>
#include <memory>

#include "elastimate/core/scene/observed_displacements.h"
#include "elastimate/estimators/displacement_fit/reduced_fit.h"
#include "elastimate/estimators/interface/estimator.h"
#include "elastimate/estimators/reduced_model/reduced_model.h"
#include "elastimate/estimators/statistics/node_losses.h"

namespace elastimate {

/// A fit of a ReducedModel.
struct ModelFit {
  ReducedFit::Point point;
  /// Of the residuals.
  double standard_deviation;
  NodeLosses losses;
  /// That of the weights which the loss gives the rows; null without a loss.
  std::unique_ptr<ReducedFit> weighted = nullptr;
};

/// The roots of the weights that losses give the rows of a residual.
Eigen::VectorXd RowWeights(const ObservedDisplacements& observed,
                           const Eigen::VectorXd& residual,
                           const NodeLosses& losses);

/// The fit of the model with a loss, by iterative reweighting from the least
/// absolute deviations, with its scale from 1.4826 MAD of the residuals.
/// Preconditions: a loss is asked for, and both bounds on nu are given.
/// Cost: O(num_nodes m^2) for each of some 10 reweightings and m basis vectors.
ModelFit FitRobustly(const ReducedModel& model,
                     const ObservedDisplacements& observed,
                     const EstimatorOptions& options,
                     const Bounds& poisson_ratio);

}  // namespace elastimate

#endif  // ELASTIMATE_ESTIMATORS_DISPLACEMENT_FIT_ROBUST_REDUCED_FIT_H_
