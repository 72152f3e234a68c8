#ifndef ELASTIMATE_IO_SCENE_MEASURED_MESH_H_
#define ELASTIMATE_IO_SCENE_MEASURED_MESH_H_

#include <string>
#include <vector>

#include "elastimate/io/mesh/mesh_file.h"
#include "elastimate/io/scene/json_value.h"

namespace elastimate {

/// The key "mesh" of a scene where it is {"points": FILE, "format", "columns",
/// "length_per_pixel", "flip_y", "max_edge"}: a planar mesh of the points that
/// a camera followed (ReadDicFile, MeshOfPoints), with their displacements as
/// the node array "displacement".  What was left out and the size of the mesh,
/// which scales E, become a notice.  Throws std::invalid_argument, naming the
/// file and the place in it.
MeshFile ReadMeasuredMesh(const JsonValue& mesh,
                          std::vector<std::string>& notices);

}  // namespace elastimate

#endif  // ELASTIMATE_IO_SCENE_MEASURED_MESH_H_
