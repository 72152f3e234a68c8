#ifndef ELASTIMATE_ESTIMATORS_STATISTICS_PROFILE_LIKELIHOOD_H_
#define ELASTIMATE_ESTIMATORS_STATISTICS_PROFILE_LIKELIHOOD_H_

#include <functional>

#include "elastimate/core/materials/elasticity.h"
#include "elastimate/estimators/interface/estimate.h"
#include "elastimate/estimators/interface/limits.h"

namespace elastimate {

/// The standard error of nu over the distance of nu to the nearer of -1 and
/// 1/2, where the responses have their poles: the displacements are linear in
/// nu within a small share of it.  Zero when there is no standard error.
double ShareOfDistanceToPole(const Estimate& estimate);

/// Of ShareOfDistanceToPole; beyond it the profile likelihood tells.
constexpr double kLargestLinearShare = 0.03;

/// The best fits at the two ends of an interval of nu.
struct Profile {
  IsotropicElasticity lower;
  IsotropicElasticity upper;
};

/// Of the least interval of nu that holds both.
Profile Hull(const Profile& one, const Profile& other);

/// Whether the 95 % interval of the profile reaches several standard errors
/// further than these, to another minimum that is nearly as good.
bool HasRivalMinimum(const std::function<Profile(double quantile)>& profile_of,
                     const Estimate& estimate);

/// Enters the 95 % interval of nu, one-sided where it reaches -1 or 1/2, and
/// widens the standard errors to it.  `profile_of` gives the ends within which
/// the sum of squares over its variance exceeds its least by no more than a
/// quantile of chi^2; ends at kSmallestPoissonRatio and kLargestPoissonRatio
/// where it never does.  Returns the interval: where the sum of squares does
/// not exceed the least up to a far end of the range, the data do not determine
/// nu, whatever the curvature at nu is.
Interval DescribeProfile(
    const std::function<Profile(double quantile)>& profile_of,
    Estimate& estimate);

}  // namespace elastimate

#endif  // ELASTIMATE_ESTIMATORS_STATISTICS_PROFILE_LIKELIHOOD_H_
