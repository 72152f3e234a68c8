#ifndef ELASTIMATE_ESTIMATORS_STATISTICS_MODEL_MISMATCH_H_
#define ELASTIMATE_ESTIMATORS_STATISTICS_MODEL_MISMATCH_H_

#include <optional>

#include "elastimate/estimators/interface/estimate.h"

namespace elastimate {

/// Hausman's check of the model [Econometrica 46 (1978) 1251]: an estimate that
/// leans on the model (reduced-fe) against one that leans less on it but uses
/// the data less well (virtual-fields).  With d their difference in (ln E, nu)
/// and C their covariances,
///
///   d^T (C_robust - C_efficient)^-1 d
///
/// is chi^2 with 2 degrees of freedom when the model holds.  The covariance of
/// the robust one alone is taken where the difference is not positive definite,
/// as estimated covariances can be.
///
/// Empty unless both estimates have finite parameters and covariances.
std::optional<ModelMismatch> FindModelMismatch(const Estimate& robust,
                                               const Estimate& efficient);

}  // namespace elastimate

#endif  // ELASTIMATE_ESTIMATORS_STATISTICS_MODEL_MISMATCH_H_
