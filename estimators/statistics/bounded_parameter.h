#ifndef ELASTIMATE_ESTIMATORS_STATISTICS_BOUNDED_PARAMETER_H_
#define ELASTIMATE_ESTIMATORS_STATISTICS_BOUNDED_PARAMETER_H_

#include <ceres/problem.h>
#include <ceres/solver.h>

#include <string>
#include <vector>

#include "elastimate/estimators/interface/estimate.h"
#include "elastimate/estimators/interface/estimator.h"
#include "elastimate/estimators/interface/evidence.h"

namespace elastimate {

/// The bound that a parameter lies on.
enum class Side { kNone, kLower, kUpper };

/// A parameter block of size one of a Ceres problem, with its bounds.
class BoundedParameter {
 public:
  /// Starts at `value`, moved into the bounds.
  BoundedParameter(double value, const Bounds& bounds);

  double Value() const { return value_; }
  double* Block() { return &value_; }
  /// Which bound it lies on.
  Side OnBound() const;

 private:
  friend ceres::Solver::Summary MinimizeWithinBounds(
      const ceres::Solver::Options& options,
      const std::vector<BoundedParameter*>& parameters,
      ceres::Problem& problem);

  void Constrain(ceres::Problem& problem);
  /// Holds it when it lies on a bound; whether it does.
  bool Hold(ceres::Problem& problem);
  /// Releases it when it is held and the cost falls towards the interior;
  /// whether it does.
  bool Release(ceres::Problem& problem);

  double value_;
  Bounds bounds_;
};

/// Minimises `problem`, which has all `parameters` as its blocks.
///
/// The projected steps of a trust region method stall on a bound, since they
/// take the step of the other parameters from the unbounded problem.  So
/// parameters that reach a bound are held there while the others converge, and
/// released again when the gradient points into the interior.
ceres::Solver::Summary MinimizeWithinBounds(
    const ceres::Solver::Options& options,
    const std::vector<BoundedParameter*>& parameters, ceres::Problem& problem);

/// How Ceres ended.
End EndOf(const ceres::Solver::Summary& summary);

}  // namespace elastimate

#endif  // ELASTIMATE_ESTIMATORS_STATISTICS_BOUNDED_PARAMETER_H_
