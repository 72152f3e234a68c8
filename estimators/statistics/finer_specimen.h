#ifndef ELASTIMATE_ESTIMATORS_STATISTICS_FINER_SPECIMEN_H_
#define ELASTIMATE_ESTIMATORS_STATISTICS_FINER_SPECIMEN_H_

#include <Eigen/Core>

namespace elastimate {

/// What is expected of alpha of a finer specimen than elements of an order:
/// quadratic elements show nearly all of the error of linear ones, and what
/// such of half the size change in quadratic ones is less than these miss by
/// 0.29 of itself, with a standard deviation of 0.13 [benchmarks: unseen,
/// calibration half].
constexpr double ExpectedShare(int order) { return order == 1 ? 1 : 1.3; }

/// Whether displacements come from a specimen that is finer than the elements
/// of a fit, or were computed with these very elements.
///
/// The finer specimen moves by a share alpha of e more, what finer elements
/// change: q = u + S d + alpha e + noise.  A fit without alpha leaves the
/// residual alpha g + noise, g = e - S c the part of e that the parameters do
/// not take up.  alpha is 0 in the one world, about ExpectedShare in the other,
/// and both are as likely before the residual is looked at.
struct FinerSpecimen {
  double probability = 0;     ///< Of the finer specimen.
  double share = 0;           ///< Expected alpha if it is finer.
  double share_variance = 0;  ///< Of alpha if it is finer.

  /// Of alpha over both worlds.
  double Mean() const { return probability * share; }
  double Variance() const {
    return probability * (share_variance + share * share) - Mean() * Mean();
  }
};

/// By Bayes' rule from the least-squares estimate of alpha, its standard error
/// and the degrees of freedom of that (Student's t), and the expected alpha.
FinerSpecimen CompareWithFinerSpecimen(double share, double standard_error,
                                       double degrees_of_freedom,
                                       double expected_share);

}  // namespace elastimate

#endif  // ELASTIMATE_ESTIMATORS_STATISTICS_FINER_SPECIMEN_H_
