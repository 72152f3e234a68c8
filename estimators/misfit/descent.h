#ifndef ELASTIMATE_ESTIMATORS_MISFIT_DESCENT_H_
#define ELASTIMATE_ESTIMATORS_MISFIT_DESCENT_H_

#include <Eigen/Core>
#include <optional>

#include "elastimate/estimators/interface/estimator.h"
#include "elastimate/estimators/misfit/displacement_misfit.h"
#include "elastimate/estimators/statistics/bounded_variables.h"

namespace elastimate {

/// How far a start is from the minimum.
enum class Distance { kFar, kNear };

/// The minimum of a misfit within bounds that a start leads to, by Ceres;
/// resultants weigh there as much as their errors say beside those of the
/// displacements, which the fit shows (some descents more).  Without
/// resultants, a descent from far that comes near a known minimum returns that.
BoundedMinimum DescendFrom(const EstimatorOptions& options,
                           const Eigen::VectorXd& start, Distance distance,
                           DisplacementMisfit& misfit,
                           const std::optional<BoundedMinimum>& known = {});

}  // namespace elastimate

#endif  // ELASTIMATE_ESTIMATORS_MISFIT_DESCENT_H_
