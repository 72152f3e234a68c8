#ifndef ELASTIMATE_CORE_MESH_REPRESENTABLE_H_
#define ELASTIMATE_CORE_MESH_REPRESENTABLE_H_

#include <sstream>
#include <stdexcept>
#include <string>

namespace elastimate {

/// Throws std::invalid_argument unless `largest`, the largest absolute value of
/// the quantity `what`, is zero or one whose products and squares (Young's
/// modulus is a force over a length and a displacement, and its variance the
/// square of that) stay in the range of a double.
inline void RequireRepresentable(double largest, const std::string& what) {
  constexpr double kSmallest = 1e-50;
  constexpr double kLargest = 1e50;
  if (largest != 0 && (largest < kSmallest || largest > kLargest)) {
    std::ostringstream message;
    message << what << " has the magnitude " << largest
            << "; choose units in which it is between " << kSmallest << " and "
            << kLargest;
    throw std::invalid_argument(message.str());
  }
}

}  // namespace elastimate

#endif  // ELASTIMATE_CORE_MESH_REPRESENTABLE_H_
