#include "benchmarks/quantile.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <utility>

namespace elastimate {

double Quantile(std::vector<double> values, double share) {
  values.erase(std::remove_if(values.begin(), values.end(),
                              [](double value) { return std::isnan(value); }),
               values.end());
  if (values.empty()) {
    return std::numeric_limits<double>::quiet_NaN();
  }
  std::sort(values.begin(), values.end());
  const double rank = share * static_cast<double>(values.size() - 1);
  const auto lower = static_cast<std::size_t>(std::floor(rank));
  const auto upper = static_cast<std::size_t>(std::ceil(rank));
  // Equal ones may be infinite.
  return values[lower] == values[upper]
             ? values[lower]
             : values[lower] + (rank - static_cast<double>(lower)) *
                                   (values[upper] - values[lower]);
}

double MedianMagnitude(std::vector<double> values) {
  for (double& value : values) {
    value = std::abs(value);
  }
  return Quantile(std::move(values), 0.5);
}

}  // namespace elastimate
