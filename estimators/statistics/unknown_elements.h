#ifndef ELASTIMATE_ESTIMATORS_STATISTICS_UNKNOWN_ELEMENTS_H_
#define ELASTIMATE_ESTIMATORS_STATISTICS_UNKNOWN_ELEMENTS_H_

namespace elastimate {

/// What elements miss where no change to finer ones is known [benchmarks:
/// unseen]: displacements of this share of the measured ones, times the share
/// of the strain energy that is missed (DiscretizationError), in the direction
/// of any parameter.
inline constexpr double kUnknownErrorShare = 0.3;
/// At most so many times the square sum of the smooth part of the residual that
/// they leave.
inline constexpr double kMostInSpan = 100;

}  // namespace elastimate

#endif  // ELASTIMATE_ESTIMATORS_STATISTICS_UNKNOWN_ELEMENTS_H_
