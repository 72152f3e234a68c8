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

/// Returns the file that a string of a scene.json names, relative to its
/// folder.  Throws std::invalid_argument, naming the place, when the string is
/// empty.
std::filesystem::path ResolvePath(const JsonValue& value);

/// Vectors of a mesh file may have these numbers of components.
std::vector<Eigen::Index> VectorSizes(const MeshFile& mesh);

/// Reads a vector per node, dimension x num_nodes, from the one of the keys
/// `file` and `array` that `value` has.  It has to be finite where `mask` is
/// set.  Throws std::invalid_argument, naming the file and the node, with this
/// mend.  `lines` gets the lines of the rows of a file.
Eigen::MatrixXd ReadNodeField(const JsonValue& value, const MeshFile& mesh,
                              const ComponentMask& mask,
                              const std::string& mend,
                              std::vector<FileLines>* lines = nullptr);

}  // namespace elastimate

#endif  // ELASTIMATE_IO_SCENE_NODE_FIELD_H_
