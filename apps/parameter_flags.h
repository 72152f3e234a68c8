#ifndef ELASTIMATE_APPS_PARAMETER_FLAGS_H_
#define ELASTIMATE_APPS_PARAMETER_FLAGS_H_

#include <Eigen/Core>

#include "elastimate/core/scene/scene.h"

namespace elastimate {

/// Throws std::invalid_argument, naming the flag, for --parameters beside
/// --youngs or --nu, one of these without the other, and values out of range.
void CheckParameterFlags();

/// Tells whether --parameters is given, or --youngs and --nu.
bool AreParametersGiven();

/// Returns the parameters of all materials of the scene: those of --parameters,
/// or E and nu alike for each.  Precondition: they are given.
Eigen::VectorXd ParametersFromFlags(const Scene& scene);

}  // namespace elastimate

#endif  // ELASTIMATE_APPS_PARAMETER_FLAGS_H_
