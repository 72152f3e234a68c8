#ifndef ELASTIMATE_APPS_MEASURED_SCENE_H_
#define ELASTIMATE_APPS_MEASURED_SCENE_H_

#include <string>
#include <vector>

#include "elastimate/core/scene/scene.h"
#include "elastimate/estimators/interface/estimator.h"
#include "elastimate/io/scene/scene_reader.h"

namespace elastimate {

/// Reads a scene with measured displacements from the files of a command line,
/// with the materials, the section, the noise and the origin that the flags
/// give.  Throws std::invalid_argument, naming the file or the flag.
SceneReading ReadMeasuredScene(const std::vector<std::string>& arguments);

/// Takes --nu for the Poisson's ratio of each material for which none is known.
/// Throws std::invalid_argument if a law has no such parameter.
void GiveKnownPoissonRatio(Scene& scene, EstimatorOptions& options);

/// Returns the files of the scene, which the library does not know and the user
/// wants to see.
std::string Sources(const std::vector<std::string>& arguments);

}  // namespace elastimate

#endif  // ELASTIMATE_APPS_MEASURED_SCENE_H_
