#ifndef ELASTIMATE_ESTIMATORS_MATERIAL_FIT_INLIER_FIT_H_
#define ELASTIMATE_ESTIMATORS_MATERIAL_FIT_INLIER_FIT_H_

#include <Eigen/Core>
#include <functional>
#include <optional>
#include <vector>

#include "elastimate/core/scene/observed_displacements.h"
#include "elastimate/core/scene/scene.h"
#include "elastimate/estimators/interface/estimate.h"
#include "elastimate/estimators/material_fit/space_fit.h"

namespace elastimate {

/// A fit without outliers, and which these are.
struct InlierFit {
  MaterialFit fit;
  std::vector<Outlier> left_out;
};

/// Fits the displacements of a scene without those of some points, from some
/// variables on.
using FitFunction =
    std::function<MaterialFit(const std::vector<Outlier>& left_out,
                              const std::optional<Eigen::VectorXd>& start)>;

/// Fits again without the outliers of a fit of all (OutlierSearch), until they
/// are those of the fit without them; only those that lie apart
/// (OutliersApart) are left out in the end, and none where they are more than
/// a third of all points, since something else is wrong then.
InlierFit LeaveOutliersOut(const Scene& scene, const FitFunction& fit_without,
                           const MaterialFit& of_all);

/// Enters which measurements were left out, and what that changed.
void EnterOutliers(const std::vector<Outlier>& left_out, const Estimate& of_all,
                   const Estimate& of_inliers, Estimate& estimate);

}  // namespace elastimate

#endif  // ELASTIMATE_ESTIMATORS_MATERIAL_FIT_INLIER_FIT_H_
