#ifndef ELASTIMATE_ESTIMATORS_MATERIAL_FIT_OUTLIERS_H_
#define ELASTIMATE_ESTIMATORS_MATERIAL_FIT_OUTLIERS_H_

#include <Eigen/Core>
#include <vector>

#include "elastimate/core/scene/observed_displacements.h"
#include "elastimate/core/scene/scene.h"
#include "elastimate/estimators/interface/estimate.h"

namespace elastimate {

/// The points so far from a displacement, num_dofs x num_load_cases, that
/// independent Gaussian noise leaves one of them in one measurement of twenty
/// at most: beyond the quantile of chi^2 for 1 - 0.05 / num_points, in units of
/// the robust standard deviation.  None where the residuals as a whole are no
/// more spread than the bulk of them (HasHeavyTails), or come from rounding.
/// `observed` is that of the scene.  By load cases, nodes before points.
/// O(num_rows).
std::vector<Outlier> FindOutliers(const Scene& scene,
                                  const ObservedDisplacements& observed,
                                  const Eigen::MatrixXd& displacement);

/// The scene without what was measured at these points.
Scene WithoutOutliers(const Scene& scene, const std::vector<Outlier>& outliers);

}  // namespace elastimate

#endif  // ELASTIMATE_ESTIMATORS_MATERIAL_FIT_OUTLIERS_H_
