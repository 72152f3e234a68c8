#ifndef ELASTIMATE_IO_SCENE_JSON_MEASUREMENT_H_
#define ELASTIMATE_IO_SCENE_JSON_MEASUREMENT_H_

#include <optional>
#include <string>
#include <vector>

#include "elastimate/core/scene/scene.h"
#include "elastimate/io/mesh/mesh_file.h"
#include "elastimate/io/points/point_locator.h"
#include "elastimate/io/scene/node_selection.h"
#include "elastimate/io/text/file_lines.h"
#include "elastimate/io/text/json_value.h"

namespace elastimate {

/// The key "observed" of a load case: what of the nodes was measured.  Throws
/// std::invalid_argument, naming the file and the place in it.
ComponentMask ReadObserved(const JsonValue& observed, const MeshFile& mesh,
                           const NodeMask& free);

/// Reads the key "displacement" of load cases: points, or a vector per node.
class MeasurementReader {
 public:
  /// The objects must outlive it; `scene_mesh` is that of the file.
  MeasurementReader(const MeshFile& mesh, const Mesh& scene_mesh)
      : mesh_(mesh), scene_mesh_(scene_mesh) {}

  /// Enters the measurement; what was observed of nodes is there already.
  /// Returns where it stands: the points file by file, or all nodes of the
  /// mesh file; nothing of an array.  Throws std::invalid_argument, naming the
  /// file and the place in it.
  std::vector<FileLines> Read(const JsonValue& displacement,
                              LoadCase& load_case,
                              std::vector<std::string>& notices);

 private:
  const MeshFile& mesh_;
  const Mesh& scene_mesh_;
  std::optional<PointLocator> locator_;  ///< Made when there are points.
  std::string unit_;  ///< The unit of the points that were read.
};

}  // namespace elastimate

#endif  // ELASTIMATE_IO_SCENE_JSON_MEASUREMENT_H_
