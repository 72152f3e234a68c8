#include "elastimate/io/scene/json_measurement.h"

#include "elastimate/io/mesh/numbering.h"
#include "elastimate/io/points/measured_points.h"
#include "elastimate/io/points/node_table.h"
#include "elastimate/io/scene/file_scene.h"
#include "elastimate/io/scene/node_field.h"
#include "elastimate/io/text/input_error.h"
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

namespace {

/// Reads the displacements of the nodes in a table; others are not observed.
FileLines ReadNumberedNodes(const JsonValue& name, const MeshFile& mesh,
                            LoadCase& load_case,
                            std::vector<std::string>& notices) {
  const std::filesystem::path path = ResolvePath(name);
  if (mesh.node_numbers.empty()) {
    name.Fail("names a table of numbered nodes, but the nodes of '" +
              PrintablePath(mesh.path) +
              "' have no numbers; give the mesh of the program that wrote the "
              "table, or \"file\" with a row for each node");
  }
  const NodeTable table = ReadNodeTable(path, mesh.Dimension());
  const Numbering numbering(mesh.node_numbers);
  ComponentMask measured =
      ComponentMask::Constant(mesh.Dimension(), mesh.nodes.cols(), false);
  load_case.displacement.setZero(mesh.Dimension(), mesh.nodes.cols());
  FileLines lines = {path, std::vector<std::size_t>(mesh.nodes.cols(), 0)};
  for (std::size_t i = 0; i < table.numbers.size(); ++i) {
    const int node = numbering.Find(table.numbers[i]);
    if (node < 0) {
      ThrowInputError(path, "line " + std::to_string(table.lines[i]) +
                                ": node " + std::to_string(table.numbers[i]) +
                                " is not in the mesh '" +
                                PrintablePath(mesh.path) +
                                "'; give the table of this mesh");
    }
    load_case.displacement.col(node) =
        table.displacement.col(static_cast<Eigen::Index>(i));
    measured.col(node) = true;
    lines.lines[node] = table.lines[i];
  }
  if (load_case.observed.size() > 0) {
    load_case.observed = load_case.observed && measured;
  } else if (!(measured.row(0) || !mesh.used).all()) {
    load_case.observed = measured;
  }
  if (table.num_states > 1) {
    notices.push_back(PrintablePath(path) + ": it has " +
                      std::to_string(table.num_states) +
                      " states, of which the last one is taken" +
                      (table.state.empty() ? "" : " (" + table.state + ")"));
  }
  return lines;
}

}  // namespace

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
  if (displacement.Has("nodes")) {
    displacement.CheckKeys({"nodes"});
    return {
        ReadNumberedNodes(displacement.At("nodes"), mesh_, load_case, notices)};
  }
  displacement.CheckKeys({"points", "nodes", "file", "array"});
  MarkObserved(mesh_, load_case);
  load_case.displacement = ReadNodeField(
      displacement, mesh_,
      load_case.observed.size() > 0 ? load_case.observed : AllComponents(mesh_),
      "correct it or leave it out of the observed nodes", &lines);
  ClearUnobserved(load_case);
  return lines;
}

}  // namespace elastimate
