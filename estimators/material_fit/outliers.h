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
class OutlierSearch {
 public:
  OutlierSearch(const Scene& scene, const ObservedDisplacements& observed,
                const Eigen::MatrixXd& displacement);

  /// Returns the outliers beyond so many times the quantile.
  std::vector<Outlier> Beyond(double distance) const;

 private:
  std::vector<Outlier> outliers_;
  std::vector<double> distances_;  ///< Over the quantile, above 1.
};

/// The nodes of supports that moved as measured, and were measured, which share
/// an element with one of these outliers.  A support follows a measurement that
/// is far off, so that its neighbours look like outliers instead.
/// O(num_elements).
std::vector<Outlier> SuspectedSupports(const Scene& scene,
                                       const std::vector<Outlier>& outliers);

/// Returns those of some outliers that lie apart: noise and mistakes of a
/// measurement strike here and there, and what a model lacks lies side by side.
/// These are all of them, unless more pairs are neighbours (VisitNeighbours)
/// than chance explains in one measurement of a thousand; then those without a
/// neighbour among them. Precondition: in the order of OutlierSearch.
/// O(num_elements + num_points).
std::vector<Outlier> OutliersApart(const Scene& scene,
                                   const ObservedDisplacements& observed,
                                   const std::vector<Outlier>& outliers);

/// Takes what was measured at these points out of a scene.
void LeaveOut(const std::vector<Outlier>& outliers, Scene& scene);
/// Returns the scene without what was measured at these points.
Scene WithoutOutliers(const Scene& scene, const std::vector<Outlier>& outliers);

}  // namespace elastimate

#endif  // ELASTIMATE_ESTIMATORS_MATERIAL_FIT_OUTLIERS_H_
