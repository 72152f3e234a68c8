#include "elastimate/estimators/interface/evidence.h"

#include <boost/math/distributions/chi_squared.hpp>

#include "elastimate/estimators/interface/limits.h"

namespace elastimate {

double ResultantMisfit::Excess() const {
  const auto count = static_cast<double>(distances.size());
  const double chi_square = distances.squaredNorm();
  return chi_square > boost::math::quantile(boost::math::complement(
                          boost::math::chi_squared(count),
                          kLimits.resultant_significance))
             ? chi_square / count
             : 1;
}

}  // namespace elastimate
