#ifndef ELASTIMATE_PYTHON_PYTHON_SCENE_H_
#define ELASTIMATE_PYTHON_PYTHON_SCENE_H_

#include <memory>
#include <string>
#include <vector>

#include "elastimate/core/scene/scene.h"

namespace elastimate {

/// A scene that Python holds.  Estimates share it, so it is not changed once it
/// is complete.
struct PythonScene {
  Scene scene;
  std::vector<std::string> notices;  ///< What a reader had to say.
  double read_seconds = 0;
};

using SharedScene = std::shared_ptr<const PythonScene>;

}  // namespace elastimate

#endif  // ELASTIMATE_PYTHON_PYTHON_SCENE_H_
