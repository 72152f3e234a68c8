#ifndef ELASTIMATE_IO_SCENE_FIRST_SCENE_H_
#define ELASTIMATE_IO_SCENE_FIRST_SCENE_H_

#include <Eigen/Core>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "elastimate/io/mesh/mesh_file.h"
#include "elastimate/io/scene/scene_reader.h"

namespace elastimate {

/// A name by which a scene.json can select parts of a mesh.
struct MeshName {
  std::string key;   ///< Of the selection: "set", "physical" or "array".
  std::string name;  ///< That of a group or, without one, its number.
  std::string what;  ///< "12 nodes", "25 nodes, 32 faces", "a region, ...".
};

/// Returns the groups of a mesh or, in a VTK file, the point arrays of one
/// component, in the order of the file.
std::vector<MeshName> NamesOf(const MeshFile& mesh);

/// What a first scene.json says.
struct FirstScene {
  std::vector<std::string> supports;  ///< Names of what is held.
  std::string loaded;                 ///< The name of a surface; may be empty.
  Eigen::VectorXd force;              ///< The total force on it [force].
  /// A table of points or of numbered nodes; may be empty.
  std::filesystem::path points;
  SectionChoice section;  ///< Of a planar mesh.
};

/// Returns the text of a scene.json at `path`, with paths relative to its
/// folder.  Throws std::invalid_argument, naming what the mesh has, for a name
/// that it does not have, for a force of another number of components than
/// its dimension, and for all that would be wrong in such a file, such as
/// points that are not there.
std::string FirstSceneText(const std::filesystem::path& path,
                           const MeshFile& mesh, const FirstScene& scene);

}  // namespace elastimate

#endif  // ELASTIMATE_IO_SCENE_FIRST_SCENE_H_
