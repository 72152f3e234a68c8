#ifndef ELASTIMATE_IO_SCENE_NODE_FIELD_H_
#define ELASTIMATE_IO_SCENE_NODE_FIELD_H_

#include <Eigen/Core>
#include <filesystem>
#include <string>
#include <vector>

#include "elastimate/core/scene/scene.h"
#include "elastimate/io/mesh/mesh_file.h"
#include "elastimate/io/text/file_lines.h"
#include "elastimate/io/text/json_value.h"

namespace elastimate {

/// The file that a string of a scene.json names, relative to its folder.
/// Throws std::invalid_argument, naming the place, when it is empty.
std::filesystem::path ResolvePath(const JsonValue& value);

/// The numbers of components that vectors of a mesh file may have.
std::vector<Eigen::Index> VectorSizes(const MeshFile& mesh);

/// A vector per node, dimension x num_nodes, from the one of the keys `file`
/// and `array` that `value` has; finite where `mask` says.  Throws
/// std::invalid_argument, naming the file and the node, with this mend. `lines`
/// gets where the rows of a file stand.
Eigen::MatrixXd ReadNodeField(const JsonValue& value, const MeshFile& mesh,
                              const ComponentMask& mask,
                              const std::string& mend,
                              std::vector<FileLines>* lines = nullptr);

}  // namespace elastimate

#endif  // ELASTIMATE_IO_SCENE_NODE_FIELD_H_
