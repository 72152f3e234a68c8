#ifndef ELASTIMATE_ESTIMATORS_STATISTICS_FINER_SPECIMEN_H_
#define ELASTIMATE_ESTIMATORS_STATISTICS_FINER_SPECIMEN_H_

#include <Eigen/Core>

namespace elastimate {

/// What is expected before the residual of a fit is looked at.
struct SpecimenPrior {
  double odds;   ///< That there is a finer specimen: its probability over rest.
  double share;  ///< Of alpha if there is.
  /// Of the change to finer elements: what the elements miss beside it, in the
  /// direction of a parameter, and by how much of itself the change of the
  /// parameters is off.
  double missed;
  double unequal;
};

/// Linear elements may have computed the displacements or not; quadratic ones
/// of the very mesh of an estimate hardly do.  These show nearly all of the
/// error of linear ones, and what such of half the size change in quadratic
/// ones is less than these miss by 0.29 of itself, with a standard deviation of
/// 0.13 [benchmarks: unseen, calibration half, as is the rest: of 504 noisy
/// fits of quadratic elements these odds leave 1 dishonest one, equal odds 3].
constexpr SpecimenPrior PriorOfSpecimen(int order) {
  return order == 1 ? SpecimenPrior{1, 1, 0.1, 0.33}
                    : SpecimenPrior{9, 1.3, 0.05, 0.15};
}

/// Whether displacements come from a specimen that is finer than the elements
/// of a fit, or were computed with these very elements.
///
/// The finer specimen moves by a share alpha of e more, what finer elements
/// change: q = u + S d + alpha e + noise.  A fit without alpha leaves the
/// residual alpha g + noise, g = e - S c the part of e that the parameters do
/// not take up.  alpha is 0 in the one world, about SpecimenPrior::share in the
/// other.
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
/// and the degrees of freedom of that (Student's t).  `missed` is what a finer
/// specimen shows beside the change, in the direction of g and over |g|, as far
/// as no data say how much that is: it makes the specimen no less likely, and
/// the estimate none of its alpha.
FinerSpecimen CompareWithFinerSpecimen(double share, double standard_error,
                                       double degrees_of_freedom, double missed,
                                       const SpecimenPrior& prior);

}  // namespace elastimate

#endif  // ELASTIMATE_ESTIMATORS_STATISTICS_FINER_SPECIMEN_H_
