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

/// Reads the key "observed" of a load case, which says what of the nodes was
/// measured.  Throws std::invalid_argument, naming the file and the place in
/// it.
ComponentMask ReadObserved(const JsonValue& observed, const MeshFile& mesh,
                           const NodeMask& free);

/// Reads the key "displacement" of load cases: points, or a vector per node.
class MeasurementReader {
 public:
  /// The objects must outlive this one; `scene_mesh` is that of the file.
  MeasurementReader(const MeshFile& mesh, const Mesh& scene_mesh)
      : mesh_(mesh), scene_mesh_(scene_mesh) {}

  /// Enters the measurement; what was observed of nodes has to be there
  /// already.  Returns the lines of the measurement: of points file by file, of
  /// all nodes of the mesh file, or nothing for an array.  Throws
  /// std::invalid_argument, naming the file and the place in it.
  std::vector<FileLines> Read(const JsonValue& displacement,
                              LoadCase& load_case,
                              std::vector<std::string>& notices);

 private:
  const MeshFile& mesh_;
  const Mesh& scene_mesh_;
  std::optional<PointLocator> locator_;  ///< Made when there are points.
  std::string unit_;                     ///< The unit of the points so far.
};

}  // namespace elastimate

#endif  // ELASTIMATE_IO_SCENE_JSON_MEASUREMENT_H_
