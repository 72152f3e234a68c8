#ifndef ELASTIMATE_PYTHON_REPORTED_SCENE_H_
#define ELASTIMATE_PYTHON_REPORTED_SCENE_H_

#include "elastimate/core/scene/scene.h"
#include "elastimate/estimators/interface/estimate.h"

namespace elastimate {

/// Returns the scene of which a report on an estimate speaks: `scene` with the
/// law that was fitted in place of the isotropic one, and with the finer
/// elements to which fits of measured displacements go on their own.
/// O(num_elements).
[[nodiscard]] Scene ReportedScene(const Scene& scene, const Estimate& estimate);

}  // namespace elastimate

#endif  // ELASTIMATE_PYTHON_REPORTED_SCENE_H_
