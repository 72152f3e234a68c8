#ifndef ELASTIMATE_IO_DIC_MEASURED_MESH_H_
#define ELASTIMATE_IO_DIC_MEASURED_MESH_H_

#include <Eigen/Core>
#include <filesystem>
#include <string>
#include <vector>

#include "elastimate/core/scene/scene.h"
#include "elastimate/io/dic/point_gaps.h"
#include "elastimate/io/mesh/mesh_file.h"
#include "elastimate/io/points/table_options.h"
#include "elastimate/io/text/json_value.h"

namespace elastimate {

/// Reads the key "mesh" of a scene where it is {"points": FILE, "max_edge",
/// "gaps"} with the keys of ReadTableOptions.  The mesh is a planar one of the
/// points that a camera followed (ReadDicFile, MeshOfPoints), with their
/// displacements as the node array "displacement".  What the camera lost of a
/// grid (GapsOf) becomes nodes without a displacement, and so do larger gaps
/// where "gaps" is "filled", or where `gaps.is_filled` says so and the key is
/// absent; `gaps.found` are those that the key says nothing about.  A notice
/// tells what was left out, and the size of the mesh, which scales E.  Throws
/// std::invalid_argument, naming the file and the place in it.
MeshFile ReadMeasuredMesh(const JsonValue& mesh, PointGaps& gaps,
                          std::vector<std::string>& notices);

/// Enters the displacements that another file of the camera has for the nodes
/// of such a mesh, 2 x n, and which of the nodes it observed.  Nodes are found
/// by their positions, to a thousandth of the least distance between two of
/// them.  Throws std::invalid_argument, naming the file, where fewer than half
/// of them were observed.
void ReadMeasuredFrame(const std::filesystem::path& path,
                       const TableOptions& options,
                       const Eigen::Matrix2Xd& nodes, LoadCase& load_case);

}  // namespace elastimate

#endif  // ELASTIMATE_IO_DIC_MEASURED_MESH_H_
