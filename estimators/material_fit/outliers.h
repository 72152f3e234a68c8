#ifndef ELASTIMATE_ESTIMATORS_MATERIAL_FIT_OUTLIERS_H_
#define ELASTIMATE_ESTIMATORS_MATERIAL_FIT_OUTLIERS_H_

#include <Eigen/Core>
#include <vector>

#include "elastimate/core/scene/observed_displacements.h"
#include "elastimate/core/scene/scene.h"

namespace elastimate {

/// The points whose residual is one that independent Gaussian noise leaves in
/// one measurement of twenty at most: beyond the quantile of chi^2 for 1 - 0.05
/// / num_points, in units of the robust standard deviation.  None where the
/// residuals as a whole are no more spread than the bulk of them
/// (HasHeavyTails).  O(num_rows).
std::vector<ObservedDisplacements::Point> FindOutliers(
    const ObservedDisplacements& observed, const Eigen::VectorXd& residual);

/// Takes what was measured at these points of the scene out of it.
void LeaveOut(const std::vector<ObservedDisplacements::Point>& points,
              Scene& scene);

}  // namespace elastimate

#endif  // ELASTIMATE_ESTIMATORS_MATERIAL_FIT_OUTLIERS_H_
