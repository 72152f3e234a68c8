#ifndef ELASTIMATE_IO_SCENE_JSON_MATERIALS_H_
#define ELASTIMATE_IO_SCENE_JSON_MATERIALS_H_

#include <vector>

#include "elastimate/core/materials/material.h"
#include "elastimate/io/mesh/mesh_file.h"
#include "elastimate/io/text/json_value.h"

namespace elastimate {

/// Whether the directions of an axis, in columns, are those of a mesh of this
/// dimension, so that a component z of a planar one is zero.
bool IsInPlane(const Eigen::MatrixXd& axis, int dimension);

/// The key "materials" of a scene: a list of {"law", "region", "known",
/// "bounds", "axis" or "axes"}, of which the last are directions or cell arrays
/// of the mesh; empty without the key.  Throws std::invalid_argument, naming
/// the file and the place in it.
std::vector<Material> ReadMaterials(const JsonValue& document,
                                    const MeshFile& mesh);

/// The cell arrays that these materials have axes from, each once.
/// Precondition: ReadMaterials takes the document.
std::vector<FileArray> AxisArrays(const JsonValue& document,
                                  const MeshFile& mesh);

}  // namespace elastimate

#endif  // ELASTIMATE_IO_SCENE_JSON_MATERIALS_H_
