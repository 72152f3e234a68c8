#ifndef ELASTIMATE_IO_SCENE_READER_H_
#define ELASTIMATE_IO_SCENE_READER_H_

#include <filesystem>
#include <string>
#include <vector>

#include "elastimate/core/scene.h"

namespace elastimate {

/// Whether a scene without measured displacements is wrong input.
enum class Measurement { kRequired, kOptional };

/// A scene as read, and what the reader has to say about it.
struct SceneReading {
  Scene scene;
  std::vector<std::string> notices;  ///< For people: points dropped, ...
};

/// Reads a scene from VTK files (.vtu, .vtk) or from one scene.json; the README
/// describes both.  Several files are further load cases of the same mesh.
///
/// The scene returned is valid (ValidateScene).  Throws std::invalid_argument
/// with one sentence that names the file and the array, key, node or element
/// for anything wrong with the input.
SceneReading ReadScene(const std::vector<std::filesystem::path>& paths,
                       Measurement measurement);

}  // namespace elastimate

#endif  // ELASTIMATE_IO_SCENE_READER_H_
