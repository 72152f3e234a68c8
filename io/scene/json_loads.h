#ifndef ELASTIMATE_IO_SCENE_JSON_LOADS_H_
#define ELASTIMATE_IO_SCENE_JSON_LOADS_H_

#include <Eigen/Core>
#include <string>
#include <vector>

#include "elastimate/core/scene/scene.h"
#include "elastimate/io/mesh/mesh_file.h"
#include "elastimate/io/scene/node_selection.h"
#include "elastimate/io/text/json_value.h"

namespace elastimate {

/// The parts of a scene that the loads of a load case refer to.
struct LoadContext {
  LoadContext(const MeshFile& mesh_file, const Mesh& scene_mesh,
              const Supports& supports_of_scene,
              std::vector<std::string>& notices_of_scene);
  /// Takes the supports of a load case instead of those of the scene.
  void SetSupports(const Supports* of_case);

  const MeshFile& mesh;
  NodeMask free;             ///< Nodes with a component that is not held.
  Eigen::MatrixXi boundary;  ///< BoundaryFacets.
  const Supports* supports;
  std::vector<std::string>& notices;
};

/// Reads the key "loads" of a load case: loads of all types, and resultants.  A
/// notice tells what may be meant in another way.  Throws
/// std::invalid_argument, naming the file and the place in it.
void ReadLoads(const JsonValue& loads, const LoadContext& context,
               LoadCase& load_case);

/// Tells whether this item of "loads" is a resultant rather than a load.
bool IsResultant(const JsonValue& load);

}  // namespace elastimate

#endif  // ELASTIMATE_IO_SCENE_JSON_LOADS_H_
