#ifndef ELASTIMATE_APPS_ERROR_FLAGS_H_
#define ELASTIMATE_APPS_ERROR_FLAGS_H_

#include "elastimate/core/equilibrium/simulated_measurement.h"

namespace elastimate {

/// Returns the errors of the simulated measurement that the flags ask for,
/// without the rigid motion, which depends on the dimension.  Throws
/// std::invalid_argument for values out of range and flags that contradict each
/// other.
MeasurementErrors ErrorsFromFlags();

/// Returns --rigid_motion in this dimension; empty without the flag.  Throws
/// std::invalid_argument where it does not have 3 or 6 finite numbers.
Eigen::VectorXd RigidMotionFromFlag(int dimension);

}  // namespace elastimate

#endif  // ELASTIMATE_APPS_ERROR_FLAGS_H_
