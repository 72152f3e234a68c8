#ifndef ELASTIMATE_IO_SCENE_JSON_SUPPORTS_H_
#define ELASTIMATE_IO_SCENE_JSON_SUPPORTS_H_

#include "elastimate/core/scene/scene.h"
#include "elastimate/io/mesh/mesh_file.h"
#include "elastimate/io/text/json_value.h"

namespace elastimate {

/// Reads the key "supports" of a scene or a load case: a list of {"nodes",
/// "components", "displacement"}.  The displacement is a vector, "measured" or
/// "rigid", and zero where it is left out.  Throws std::invalid_argument,
/// naming the file and the place in it.
Supports ReadSupports(const JsonValue& document, const MeshFile& mesh);

}  // namespace elastimate

#endif  // ELASTIMATE_IO_SCENE_JSON_SUPPORTS_H_
