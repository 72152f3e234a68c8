#ifndef ELASTIMATE_PYTHON_PYTHON_SCENE_H_
#define ELASTIMATE_PYTHON_PYTHON_SCENE_H_

#include <memory>
#include <string>
#include <vector>

#include "elastimate/core/scene/scene.h"
#include "python/given_mesh.h"

namespace elastimate {

/// A scene that Python holds.  Estimates share it, so it is not changed once it
/// is complete.
struct PythonScene {
  Scene scene;
  std::vector<std::string> notices;  ///< What a reader had to say.
  double read_seconds = 0;
  /// The mesh that the caller gave, by whose numbers Python names nodes and
  /// cells; null for a scene from files.
  std::shared_ptr<const GivenMesh> given;
};

using SharedScene = std::shared_ptr<const PythonScene>;

}  // namespace elastimate

#endif  // ELASTIMATE_PYTHON_PYTHON_SCENE_H_
