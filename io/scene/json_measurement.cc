#include "elastimate/io/scene/json_measurement.h"

#include "elastimate/io/points/measured_points.h"
#include "elastimate/io/scene/file_scene.h"
#include "elastimate/io/scene/node_field.h"
#include "elastimate/io/text/printable.h"

namespace elastimate {

ComponentMask ReadObserved(const JsonValue& observed, const MeshFile& mesh,
                           const NodeMask& free) {
  if (!observed.IsString() && observed.Has("array")) {
    observed.CheckKeys({"array"});
    const JsonValue name = observed.At("array");
    std::vector<Eigen::Index> sizes = VectorSizes(mesh);
    sizes.push_back(1);
    return ToComponentMask(mesh.path,
                           "the point array '" + Printable(name.String()) + "'",
                           mesh, NamedNodeArray(name, mesh, sizes));
  }
  return SelectNodes(observed, mesh, &free).replicate(mesh.Dimension(), 1);
}

std::vector<FileLines> MeasurementReader::Read(
    const JsonValue& displacement, LoadCase& load_case,
    std::vector<std::string>& notices) {
  std::vector<FileLines> lines;
  if (displacement.Has("points")) {
    if (load_case.observed.size() > 0) {
      displacement.Fail(
          "names measured points, but \"observed\" chooses among nodes; leave "
          "out \"observed\"");
    }
    if (!locator_) {
      locator_.emplace(scene_mesh_);
    }
    load_case.points = ReadMeasuredPoints(displacement, scene_mesh_, *locator_,
                                          unit_, notices, lines);
    return lines;
  }
  displacement.CheckKeys({"file", "array"});
  load_case.displacement = ReadNodeField(
      displacement, mesh_,
      load_case.observed.size() > 0 ? load_case.observed : AllComponents(mesh_),
      "correct it or leave it out of the observed nodes", &lines);
  ClearUnobserved(load_case);
  return lines;
}

}  // namespace elastimate
