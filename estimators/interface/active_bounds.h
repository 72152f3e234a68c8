#ifndef ELASTIMATE_ESTIMATORS_INTERFACE_ACTIVE_BOUNDS_H_
#define ELASTIMATE_ESTIMATORS_INTERFACE_ACTIVE_BOUNDS_H_

namespace elastimate {

/// The bound that a parameter lies on.
enum class Side { kNone, kLower, kUpper };

/// Which bounds hold an estimate.
struct ActiveBounds {
  Side youngs_modulus = Side::kNone;
  Side poisson_ratio = Side::kNone;
  /// nu has run into the end of its physical range, which no option set.
  bool is_physical_limit = false;

  bool Any() const {
    return youngs_modulus != Side::kNone || poisson_ratio != Side::kNone;
  }
};

}  // namespace elastimate

#endif  // ELASTIMATE_ESTIMATORS_INTERFACE_ACTIVE_BOUNDS_H_
