#ifndef ELASTIMATE_IO_SCENE_JSON_MATERIALS_H_
#define ELASTIMATE_IO_SCENE_JSON_MATERIALS_H_

#include <map>
#include <string>
#include <vector>

#include "elastimate/core/materials/material.h"
#include "elastimate/io/mesh/mesh_file.h"
#include "elastimate/io/text/json_value.h"

namespace elastimate {

/// Tells whether the directions of an axis, in columns, fit a mesh of this
/// dimension: a component z of a planar one has to be zero.
bool IsInPlane(const Eigen::MatrixXd& axis, int dimension);

/// Returns the law that has the axis of `law` among its parameters, which
/// "axis": "free" asks for; empty where there is none.
std::string LawOfFreeAxis(const std::string& law);
/// Returns the end of a sentence, "which ...; ...", on a law that has none.
std::string WhyNoFreeAxis();

/// Reads the key "regions" of a scene, {"array": NAME}: takes the regions from
/// the cell array of that name, in the place of `region` and physical groups.
/// Throws std::invalid_argument, naming the file and the place in it, where the
/// mesh has no such array.
/// mesh has none.
void ChooseRegions(const JsonValue& document, MeshFile& mesh);

/// Reads the key "materials" of a scene: a list of {"law", "region", "known",
/// "bounds", "axis" or "axes"}.  Axes are directions or cell arrays of the
/// mesh, and "axis" may be "free".  A region is an id or, where regions are
/// physical groups, the name of one.  Returns none without the key.  Throws
/// std::invalid_argument, naming the file and the place in it.
std::vector<Material> ReadMaterials(const JsonValue& document,
                                    const MeshFile& mesh);

/// Returns the cell arrays from which these materials have axes, by name.
/// Precondition: ReadMaterials takes the document.
std::map<std::string, Eigen::MatrixXd> AxisArrays(const JsonValue& document,
                                                  const MeshFile& mesh);

}  // namespace elastimate

#endif  // ELASTIMATE_IO_SCENE_JSON_MATERIALS_H_
