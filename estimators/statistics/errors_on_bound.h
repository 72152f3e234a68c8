#ifndef ELASTIMATE_ESTIMATORS_STATISTICS_ERRORS_ON_BOUND_H_
#define ELASTIMATE_ESTIMATORS_STATISTICS_ERRORS_ON_BOUND_H_

#include "elastimate/estimators/interface/estimate.h"
#include "elastimate/estimators/interface/estimator.h"
#include "elastimate/estimators/interface/evidence.h"

namespace elastimate {

/// For nu on a bound: what nu may be off by, and with it E; adds that of E to
/// its variance where a bound was given.  `slope` = d ln E / d nu of the
/// parameters that fit alike; `standard_error` is that of nu without the bound.
ErrorsOnBound AllowForPoissonRatioOnBound(const EstimatorOptions& options,
                                          const ActiveBounds& active,
                                          double slope, double standard_error,
                                          Estimate& estimate);

/// For E on a bound: what E may be off by, and with it nu, unless nu is known;
/// adds that of nu to its variance.  `slope` = d nu / d ln E of the parameters
/// that fit alike; `standard_error` is that of ln E without the bound.
ErrorsOnBound AllowForYoungsModulusOnBound(const EstimatorOptions& options,
                                           double slope, double standard_error,
                                           Estimate& estimate);

}  // namespace elastimate

#endif  // ELASTIMATE_ESTIMATORS_STATISTICS_ERRORS_ON_BOUND_H_
