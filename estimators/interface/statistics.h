#ifndef ELASTIMATE_ESTIMATORS_INTERFACE_STATISTICS_H_
#define ELASTIMATE_ESTIMATORS_INTERFACE_STATISTICS_H_

#include <Eigen/Core>
#include <string>
#include <vector>

#include "elastimate/estimators/interface/estimate.h"

namespace elastimate {

/// A standard error of nu above this says that the data do not determine nu:
/// its whole range for common materials is 0 to 0.5.
constexpr double kLargestPoissonRatioError = 0.15;

/// An end of the 95 % interval of nu further than this from the estimate says
/// the same.
constexpr double kLargestPoissonRatioDistance =
    1.960 * kLargestPoissonRatioError;

/// A relative standard error of E above this says that the data do not
/// determine E: zero and infinity are within three standard errors.
constexpr double kLargestYoungsModulusError = 1.0 / 3;

/// The median; the mean of the middle two of an even number of values.
/// Precondition: not empty.  O(n).
double Median(std::vector<double> values);

/// The minimiser t of the sum of |y_i - t x_i|: the median of y_i / x_i with
/// weights |x_i|.  Precondition: some x_i is not zero.  O(n log n).
double LeastAbsoluteDeviations(const Eigen::VectorXd& x,
                               const Eigen::VectorXd& y);

/// A number for a sentence, to two significant digits.
std::string TwoDigits(double value);

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

#endif  // ELASTIMATE_ESTIMATORS_INTERFACE_STATISTICS_H_
