#ifndef ELASTIMATE_IO_SCENE_JSON_MATERIALS_H_
#define ELASTIMATE_IO_SCENE_JSON_MATERIALS_H_

#include <vector>

#include "elastimate/core/materials/material.h"
#include "elastimate/io/text/json_value.h"

namespace elastimate {

/// The key "materials" of a scene: a list of {"law", "region", "known",
/// "bounds"}; empty without the key.  Throws std::invalid_argument, naming the
/// file and the place in it.
std::vector<Material> ReadMaterials(const JsonValue& document);

}  // namespace elastimate

#endif  // ELASTIMATE_IO_SCENE_JSON_MATERIALS_H_
