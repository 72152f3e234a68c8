#include "elastimate/io/scene/json_scene.h"

#include <sstream>
#include <string>
#include <utility>
#include <vector>

#include "elastimate/io/scene/csv_field.h"
#include "elastimate/io/scene/json_value.h"
#include "elastimate/io/scene/mesh_reader.h"
#include "elastimate/io/scene/node_selection.h"
#include "elastimate/io/text/input_error.h"
#include "elastimate/io/text/printable.h"

namespace elastimate {
namespace {

/// What the load cases of one document are read against.
struct Context {
  const MeshFile& mesh;
  NodeMask free;             ///< Nodes with a component that is not held.
  Eigen::MatrixXi boundary;  ///< BoundaryFacets.
  std::vector<std::string>& notices;
};

std::filesystem::path ResolvePath(const JsonValue& value) {
  const std::string name = value.String();
  if (name.empty()) {
    value.Fail("is empty; give the path of a file");
  }
  return value.File().parent_path() / name;
}

/// The components that e.g. "xz" names.
Eigen::Array3<bool> ReadComponents(const JsonValue& support) {
  if (!support.Has("components")) {
    return Eigen::Array3<bool>::Constant(true);
  }
  const JsonValue value = support.At("components");
  Eigen::Array3<bool> components = Eigen::Array3<bool>::Constant(false);
  for (const char letter : value.String()) {
    const std::size_t axis = std::string("xyz").find(letter);
    if (axis == std::string::npos || components[axis]) {
      value.Fail("must name each of x, y and z at most once, like \"xz\"");
    }
    components[axis] = true;
  }
  if (!components.any()) {
    value.Fail("is empty; name some of x, y and z");
  }
  return components;
}

void AddSupport(const JsonValue& support, const MeshFile& mesh,
                Supports& supports) {
  support.CheckKeys({"nodes", "components", "displacement"});
  const NodeMask nodes = SelectNodes(support.At("nodes"), mesh, nullptr);
  const Eigen::Array3<bool> components = ReadComponents(support);
  const Eigen::Vector3d displacement = support.Has("displacement")
                                           ? support.At("displacement").Vector()
                                           : Eigen::Vector3d::Zero();
  for (Eigen::Index node = 0; node < nodes.size(); ++node) {
    for (Eigen::Index axis = 0; axis < 3 && nodes[node]; ++axis) {
      if (!components[axis]) {
        continue;
      }
      if (supports.held(axis, node) &&
          supports.displacement(axis, node) != displacement[axis]) {
        support.Fail("holds the " + std::string(1, "xyz"[axis]) +
                     " component of " + NodeName(mesh, node) +
                     " at another displacement than a support before it; "
                     "select each only once");
      }
      supports.held(axis, node) = true;
      supports.displacement(axis, node) = displacement[axis];
    }
  }
}

MeshFile ReadNamedMesh(const JsonValue& name) {
  const std::filesystem::path path = ResolvePath(name);
  if (FileExtension(path) == ".json") {
    name.Fail("is '" + Printable(name.String()) +
              "', which is a scene; name a mesh file (.vtu, .vtk, .msh, .mesh, "
              ".unv or .bdf)");
  }
  return ReadMeshFile(path);
}

Supports ReadSupports(const JsonValue& document, const MeshFile& mesh) {
  Supports supports;
  supports.held.setConstant(3, mesh.nodes.cols(), false);
  supports.displacement.setZero(3, mesh.nodes.cols());
  for (const JsonValue& support : document.At("supports").Items()) {
    AddSupport(support, mesh, supports);
  }
  return supports;
}

/// Three numbers per node, from the one of the keys `file` and `array` that
/// `value` has; finite where `mask` says.
Eigen::MatrixXd ReadField(const JsonValue& value, const MeshFile& mesh,
                           const ComponentMask& mask, const std::string& mend) {
  if (value.Has("file") == value.Has("array")) {
    value.Fail("must have exactly one of the keys file, array");
  }
  Eigen::MatrixXd field;
  std::filesystem::path file = mesh.path;
  std::string what;
  if (value.Has("file")) {
    RequireNodePositions(mesh);
    file = ResolvePath(value.At("file"));
    field = ReadCsvField(file, mesh.nodes.cols());
    what = "the row";
  } else {
    field = NamedNodeArray(value.At("array"), mesh, 3);
    what = "the point array '" + Printable(value.At("array").String()) + "'";
  }
  RequireFinite(file, what, mesh, field, mask, mend);
  return field;
}

std::string ListText(const Eigen::Vector3d& values) {
  std::ostringstream text;
  text << "[" << values[0] << ", " << values[1] << ", " << values[2] << "]";
  return text.str();
}

/// A total that is given as a nodal force would be as many times too large as
/// there are nodes, and Young's modulus with it.
void NoteForcePerNode(const JsonValue& load, const Eigen::Vector3d& value,
                      Eigen::Index num_nodes, const Context& context) {
  const JsonValue nodes = load.At("nodes");
  const bool names_a_part = !nodes.IsString() && !nodes.Has("ids");
  if (!names_a_part || num_nodes == 1 || value.isZero(0)) {
    return;
  }
  context.notices.push_back(
      PrintablePath(load.File()) + ": " + load.Place() +
      " is a nodal_force, which acts once per node: " + ListText(value) +
      " on each of " + std::to_string(num_nodes) + " nodes, " +
      ListText(static_cast<double>(num_nodes) * value) + " in total; if " +
      ListText(value) +
      " is the total, give it as \"type\": \"force\" with a \"surface\"");
}

NodalForces ReadNodalForces(const JsonValue& load, const Context& context) {
  load.CheckKeys({"type", "value", "nodes", "file", "array"});
  if (load.Has("file") || load.Has("array")) {
    if (load.Has("value") || load.Has("nodes")) {
      load.Fail("must have either value and nodes, or one of file and array");
    }
    return {
        ReadField(load, context.mesh,
                  ComponentMask::Constant(3, context.mesh.nodes.cols(), true),
                  "correct it")};
  }
  const Eigen::Vector3d value = load.At("value").Vector();
  const NodeMask nodes =
      SelectNodes(load.At("nodes"), context.mesh, &context.free);
  NoteForcePerNode(load, value, nodes.count(), context);
  return {value * nodes.cast<double>().matrix()};
}

Load ReadLoad(const JsonValue& load, const Context& context) {
  const auto facets = [&] {
    return SelectFacets(load.At("surface"), context.mesh, context.free,
                        context.boundary);
  };
  const JsonValue type = load.At("type");
  const std::string name = type.String();
  if (name == "nodal_force") {
    return ReadNodalForces(load, context);
  }
  if (name == "body_force") {
    load.CheckKeys({"type", "value"});
    return BodyForce{load.At("value").Vector()};
  }
  if (name == "traction") {
    load.CheckKeys({"type", "value", "surface"});
    return Traction{facets(), load.At("value").Vector()};
  }
  if (name == "pressure") {
    load.CheckKeys({"type", "value", "surface"});
    return Pressure{facets(), load.At("value").Number()};
  }
  if (name == "force") {
    load.CheckKeys({"type", "value", "surface"});
    return SurfaceForce{facets(), load.At("value").Vector()};
  }
  type.Fail("is \"" + Printable(name) +
            "\"; the types known here are force, nodal_force, body_force, "
            "traction, pressure");
}

ComponentMask ReadObserved(const JsonValue& observed, const Context& context) {
  const MeshFile& mesh = context.mesh;
  if (!observed.IsString() && observed.Has("array")) {
    observed.CheckKeys({"array"});
    const JsonValue name = observed.At("array");
    return ToComponentMask(mesh.path,
                           "the point array '" + Printable(name.String()) + "'",
                           mesh, NamedNodeArray(name, mesh, 3, 1));
  }
  return SelectNodes(observed, mesh, &context.free).replicate(3, 1);
}

LoadCase ReadLoadCase(const JsonValue& value, const Context& context,
                      Measurement measurement) {
  value.CheckKeys({"displacement", "loads", "noise_sd", "observed"});
  LoadCase load_case;
  for (const JsonValue& load : value.At("loads").Items()) {
    load_case.loads.push_back(ReadLoad(load, context));
  }
  if (value.Has("noise_sd")) {
    load_case.noise_sd = value.At("noise_sd").Number();
    if (!(*load_case.noise_sd > 0)) {
      value.At("noise_sd").Fail("must be positive");
    }
  }
  if (value.Has("observed")) {
    load_case.observed = ReadObserved(value.At("observed"), context);
  }
  if (value.Has("displacement") || measurement == Measurement::kRequired) {
    const JsonValue displacement = value.At("displacement");
    displacement.CheckKeys({"file", "array"});
    load_case.displacement = ReadField(
        displacement, context.mesh,
        load_case.observed.size() > 0
            ? load_case.observed
            : ComponentMask::Constant(3, context.mesh.nodes.cols(), true),
        "correct it or leave it out of the observed nodes");
    ClearUnobserved(load_case);
  }
  return load_case;
}

}  // namespace

FileScene ReadJsonScene(const std::filesystem::path& path,
                        Measurement measurement) {
  const nlohmann::json parsed = ParseJsonFile(path);
  const JsonValue document(path, parsed);
  document.CheckKeys({"mesh", "supports", "cases"});
  FileScene file_scene;
  file_scene.mesh = ReadNamedMesh(document.At("mesh"));
  const MeshFile& mesh = file_scene.mesh;
  file_scene.scene.mesh.nodes = mesh.nodes;
  file_scene.scene.mesh.elements = mesh.tetrahedra;
  file_scene.scene.mesh.regions = ReadRegions(mesh);
  file_scene.scene.supports = ReadSupports(document, mesh);
  const Context context = {
      mesh, !file_scene.scene.supports.held.colwise().all() && mesh.used,
      BoundaryFacets(file_scene.scene.mesh), file_scene.notices};
  const std::vector<JsonValue> cases = document.At("cases").Items();
  if (cases.empty()) {
    document.At("cases").Fail("is empty; give at least one load case");
  }
  for (const JsonValue& load_case : cases) {
    file_scene.scene.load_cases.push_back(
        ReadLoadCase(load_case, context, measurement));
  }
  return file_scene;
}

}  // namespace elastimate
