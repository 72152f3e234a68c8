#ifndef ELASTIMATE_APPS_ESTIMATOR_FLAGS_H_
#define ELASTIMATE_APPS_ESTIMATOR_FLAGS_H_

#include <optional>
#include <string>

#include "elastimate/core/scene/scene.h"
#include "elastimate/estimators/interface/estimator.h"

namespace elastimate {

/// The options that the flags give.  Throws std::invalid_argument, naming the
/// flags, for what the library would refuse by its own names.
EstimatorOptions OptionsFromFlags();

/// Returns the origin that --origin names; empty where the flag is not given.
/// Throws std::invalid_argument for any other word.
std::optional<Origin> OriginFromFlag();

/// Returns the solver that --solver names.  Throws std::invalid_argument for
/// any other word, and for multigrid where it is not there.
SolverKind SolverFromFlag();

/// Throws std::invalid_argument unless --nu is a Poisson's ratio.
void CheckPoissonRatioFlag();

/// Returns the flags behind the options as they were given, such as
/// "--nu_min=0.2 --loss=huber"; empty when there are none.
std::string GivenOptionFlags();

}  // namespace elastimate

#endif  // ELASTIMATE_APPS_ESTIMATOR_FLAGS_H_
