#ifndef ELASTIMATE_ESTIMATORS_MATERIAL_FIT_MINIMUM_STATISTICS_H_
#define ELASTIMATE_ESTIMATORS_MATERIAL_FIT_MINIMUM_STATISTICS_H_

#include <Eigen/Core>
#include <optional>

#include "elastimate/core/scene/scene.h"
#include "elastimate/estimators/interface/estimate.h"
#include "elastimate/estimators/interface/evidence.h"
#include "elastimate/estimators/material_fit/displacement_misfit.h"
#include "elastimate/estimators/statistics/element_errors.h"

namespace elastimate {

/// A minimum, corrected for what the elements miss.
struct CorrectedMinimum {
  Eigen::VectorXd variables;
  /// Of the change to finer elements, as far as it is expected to be there.
  double share_of_finer = 0;
};

/// Enters the noise and the covariance of a minimum into the estimate, whose
/// parameters are entered, and what there is to judge into the evidence:
///
///   sigma^2 (S^T S)^-1, the Cramer-Rao bound, with sigma^2 as given or from
///     the residual,
///   + what correlated residuals add to it (DescribeCorrelation),
///   + (S^T S)^-1 times the square sum of a residual that is alike over the
///     specimen, which no noise is,
///   + the square of what outliers that are left pull the parameters by.
///
/// An evaluation, and O(n^2) for n points in a load case (CorrelateResiduals).
///
/// `change` is that of the rows to finer elements, where it is known: what of
/// it the residual shows corrects the parameters that are entered, and its
/// error is part of theirs (ElementErrors).
CorrectedMinimum DescribeMinimum(const Scene& scene,
                                 const Eigen::VectorXd& variables,
                                 const std::optional<RowChange>& change,
                                 DisplacementMisfit& misfit, Evidence& evidence,
                                 Estimate& estimate);

}  // namespace elastimate

#endif  // ELASTIMATE_ESTIMATORS_MATERIAL_FIT_MINIMUM_STATISTICS_H_
