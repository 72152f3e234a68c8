#ifndef ELASTIMATE_IO_SCENE_JSON_SCENE_H_
#define ELASTIMATE_IO_SCENE_JSON_SCENE_H_

#include <filesystem>
#include <vector>

#include "elastimate/io/scene/file_scene.h"
#include "elastimate/io/scene/scene_reader.h"
#include "elastimate/io/text/json_value.h"

namespace elastimate {

/// Reads a scene.json and the files it names, as ReadScene describes.  Throws
/// std::invalid_argument, naming the file and the place in it.
FileScene ReadJsonScene(const std::filesystem::path& path,
                        Measurement measurement, const SceneChoices& choices);

/// Reads the scene of the contents of such a file.
FileScene ReadJsonScene(const JsonValue& document, Measurement measurement,
                        const SceneChoices& choices);

}  // namespace elastimate

#endif  // ELASTIMATE_IO_SCENE_JSON_SCENE_H_
