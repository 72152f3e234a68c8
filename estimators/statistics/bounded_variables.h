#ifndef ELASTIMATE_ESTIMATORS_STATISTICS_BOUNDED_VARIABLES_H_
#define ELASTIMATE_ESTIMATORS_STATISTICS_BOUNDED_VARIABLES_H_

#include <ceres/solver.h>

#include <Eigen/Core>
#include <functional>
#include <string>
#include <vector>

#include "elastimate/estimators/interface/evidence.h"
#include "elastimate/estimators/interface/free_parameters.h"
#include "elastimate/estimators/interface/parameter_judge.h"

namespace elastimate {

/// The bound that a variable lies on.
enum class Side { kNone, kLower, kUpper };

/// A minimum of ||r(x)||^2 / 2 over the variables within their bounds.
struct BoundedMinimum {
  Eigen::VectorXd variables;
  double cost;
  std::vector<Side> on_bound;  ///< Which bound each variable lies on.
  End end;
  std::string message;  ///< What Ceres says of its end.
  /// The variables where another model of the specimen that may be the right
  /// one explains the data about as well; empty where there is none.
  Eigen::VectorXd of_other_model = {};
};

/// r and, where it is asked for, dr/dx (of the size of r x that of x); false
/// when there is none at x.
using ResidualFunction =
    std::function<bool(const Eigen::VectorXd& variables,
                       Eigen::VectorXd* residual, Eigen::MatrixXd* jacobian)>;

/// By Ceres' trust region method from `start` on.  `residual` is asked for a
/// value before its Jacobian at the same x.  What has no bound keeps within a
/// factor of e^14, a million, of the start.
BoundedMinimum MinimizeOverVariables(const ResidualFunction& residual,
                                     Eigen::Index num_residuals,
                                     const std::vector<Bounds>& bounds,
                                     const Eigen::VectorXd& start,
                                     const ceres::Solver::Options& options);

/// Enters the bounds that hold the minimum into the estimate, whose parameters
/// are entered, with a warning, and which are the ends of the range of a
/// Poisson's ratio.
void NoteVariablesOnBounds(const FreeParameters& free,
                           const BoundedMinimum& minimum, Evidence& evidence,
                           Estimate& estimate);

}  // namespace elastimate

#endif  // ELASTIMATE_ESTIMATORS_STATISTICS_BOUNDED_VARIABLES_H_
