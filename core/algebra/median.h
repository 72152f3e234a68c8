#ifndef ELASTIMATE_CORE_ALGEBRA_MEDIAN_H_
#define ELASTIMATE_CORE_ALGEBRA_MEDIAN_H_

#include <vector>

namespace elastimate {

/// The median; the mean of the middle two of an even number of values.
/// Precondition: not empty.  O(n).
double Median(std::vector<double> values);

}  // namespace elastimate

#endif  // ELASTIMATE_CORE_ALGEBRA_MEDIAN_H_
