#ifndef ELASTIMATE_IO_DIC_MEASURED_MESH_H_
#define ELASTIMATE_IO_DIC_MEASURED_MESH_H_

#include <Eigen/Core>
#include <filesystem>
#include <string>
#include <vector>

#include "elastimate/core/scene/scene.h"
#include "elastimate/io/mesh/mesh_file.h"
#include "elastimate/io/points/table_options.h"
#include "elastimate/io/text/json_value.h"

namespace elastimate {

/// The key "mesh" of a scene where it is {"points": FILE, "max_edge"} with the
/// keys of ReadTableOptions: a planar mesh of the points that a camera followed
/// (ReadDicFile, MeshOfPoints), with their displacements as the node array
/// "displacement".  What was left out and the size of the mesh,
/// which scales E, become a notice.  Throws std::invalid_argument, naming the
/// file and the place in it.
MeshFile ReadMeasuredMesh(const JsonValue& mesh,
                          std::vector<std::string>& notices);

/// Enters what another file of the camera says of the nodes of such a mesh, 2 x
/// n, which are found by their positions, to a thousandth of the least distance
/// between two of them: their displacement, and which of them were observed.
/// Throws std::invalid_argument, naming the file, where fewer than half of them
/// were.
void ReadMeasuredFrame(const std::filesystem::path& path,
                       const TableOptions& options,
                       const Eigen::Matrix2Xd& nodes, LoadCase& load_case);

}  // namespace elastimate

#endif  // ELASTIMATE_IO_DIC_MEASURED_MESH_H_
