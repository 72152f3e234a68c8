#ifndef ELASTIMATE_BENCHMARKS_QUANTILE_H_
#define ELASTIMATE_BENCHMARKS_QUANTILE_H_

#include <vector>

namespace elastimate {

/// The value that `share` of the values do not exceed, linear between two of
/// them (1/2: the median).  Values that are not numbers are left out; NaN when
/// none is left.  Precondition: share in [0, 1].  O(n log n).
double Quantile(std::vector<double> values, double share);

/// The median of the absolute values, likewise.
double MedianMagnitude(std::vector<double> values);

}  // namespace elastimate

#endif  // ELASTIMATE_BENCHMARKS_QUANTILE_H_
