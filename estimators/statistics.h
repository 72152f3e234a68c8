#ifndef ELASTIMATE_ESTIMATORS_STATISTICS_H_
#define ELASTIMATE_ESTIMATORS_STATISTICS_H_

#include <Eigen/Core>
#include <string>
#include <vector>

#include "elastimate/estimators/estimate.h"

namespace elastimate {

/// The median; the mean of the middle two of an even number of values.
/// Precondition: not empty.  O(n).
double Median(std::vector<double> values);

/// One sentence about an estimate whose nu is not determined: which modulus
/// the covariance says is determined all the same (E, mu, kappa or none, to
/// 10 %), and what to do.  Precondition: a finite elasticity.
std::string DescribeWhatIsDetermined(const Estimate& estimate);

/// One sentence about data that determine one combination of E and nu only,
/// which leaves `direction` in (ln E, nu) free: names the modulus that does not
/// change along it, if one of E, mu and kappa does not, with its value at
/// `elasticity`, and says what to do.
std::string DescribeCollinear(const IsotropicElasticity& elasticity,
                              const Eigen::Vector2d& direction);

}  // namespace elastimate

#endif  // ELASTIMATE_ESTIMATORS_STATISTICS_H_
