#ifndef ELASTIMATE_IO_SCENE_JSON_MATERIALS_H_
#define ELASTIMATE_IO_SCENE_JSON_MATERIALS_H_

#include <map>
#include <string>
#include <vector>

#include "elastimate/core/materials/material.h"
#include "elastimate/io/mesh/mesh_file.h"
#include "elastimate/io/text/json_value.h"

namespace elastimate {

/// Whether the directions of an axis, in columns, are those of a mesh of this
/// dimension, so that a component z of a planar one is zero.
bool IsInPlane(const Eigen::MatrixXd& axis, int dimension);

/// What "axis": "free" makes of a law: the one that has the axis among its
/// parameters; empty where there is none.
std::string LawOfFreeAxis(const std::string& law);
/// "which ...; ...", of a law that has none.
std::string WhyNoFreeAxis();

/// The key "regions" of a scene, {"array": NAME}: takes the regions from the
/// cell array of that name, in the place of `region` and physical groups.
/// Throws std::invalid_argument, naming the file and the place in it, where the
/// mesh has none.
void ChooseRegions(const JsonValue& document, MeshFile& mesh);

/// The key "materials" of a scene: a list of {"law", "region", "known",
/// "bounds", "axis" or "axes"}, of which the last are directions or cell arrays
/// of the mesh, and "axis" may be "free"; a region is an id or, where regions
/// are physical groups, the name of one.  Empty without the key.  Throws
/// std::invalid_argument, naming the file and the place in it.
std::vector<Material> ReadMaterials(const JsonValue& document,
                                    const MeshFile& mesh);

/// The cell arrays that these materials have axes from, by name.
/// Precondition: ReadMaterials takes the document.
std::map<std::string, Eigen::MatrixXd> AxisArrays(const JsonValue& document,
                                                  const MeshFile& mesh);

}  // namespace elastimate

#endif  // ELASTIMATE_IO_SCENE_JSON_MATERIALS_H_
