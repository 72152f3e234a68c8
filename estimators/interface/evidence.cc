#include "elastimate/estimators/interface/evidence.h"

#include "elastimate/estimators/interface/limits.h"
#include "elastimate/estimators/interface/statistics.h"

namespace elastimate {

double ResultantMisfit::Excess() const {
  const auto count = static_cast<double>(distances.size());
  const double chi_square = distances.squaredNorm();
  return chi_square > ChiSquaredQuantile(count, kLimits.resultant_significance)
             ? chi_square / count
             : 1;
}

}  // namespace elastimate
