#include "elastimate/io/scene/json_scene.h"

#include <limits>
#include <optional>
#include <sstream>
#include <string>
#include <utility>
#include <vector>

#include "elastimate/core/materials/laws.h"
#include "elastimate/io/points/point_locator.h"
#include "elastimate/io/scene/csv_field.h"
#include "elastimate/io/scene/json_value.h"
#include "elastimate/io/scene/measured_points.h"
#include "elastimate/io/scene/mesh_reader.h"
#include "elastimate/io/scene/node_selection.h"
#include "elastimate/io/scene/section.h"
#include "elastimate/io/text/input_error.h"
#include "elastimate/io/text/printable.h"

namespace elastimate {
namespace {

/// What the load cases of one document are read against.
struct Context {
  const MeshFile& mesh;
  NodeMask free;             ///< Nodes with a component that is not held.
  Eigen::MatrixXi boundary;  ///< BoundaryFacets.
  const Mesh& scene_mesh;
  /// Of the scene's mesh; made when there are points.
  std::optional<PointLocator> locator;
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
Eigen::Array<bool, Eigen::Dynamic, 1> ReadComponents(const JsonValue& support,
                                                     int dimension) {
  using Components = Eigen::Array<bool, Eigen::Dynamic, 1>;
  if (!support.Has("components")) {
    return Components::Constant(dimension, true);
  }
  const JsonValue value = support.At("components");
  const std::string axes = dimension == 3 ? "xyz" : "xy";
  const std::string names = dimension == 3 ? "x, y and z" : "x and y";
  Components components = Components::Constant(dimension, false);
  for (const char letter : value.String()) {
    const std::size_t axis = axes.find(letter);
    if (axis == std::string::npos ||
        components[static_cast<Eigen::Index>(axis)]) {
      value.Fail("must name each of " + names + " at most once, like \"" +
                 (dimension == 3 ? "xz" : "xy") + "\"");
    }
    components[static_cast<Eigen::Index>(axis)] = true;
  }
  if (!components.any()) {
    value.Fail("is empty; name some of " + names);
  }
  return components;
}

void AddSupport(const JsonValue& support, const MeshFile& mesh,
                Supports& supports) {
  support.CheckKeys({"nodes", "components", "displacement"});
  const NodeMask nodes = SelectNodes(support.At("nodes"), mesh, nullptr);
  const int dimension = mesh.Dimension();
  const auto components = ReadComponents(support, dimension);
  const Eigen::VectorXd displacement =
      support.Has("displacement") ? support.At("displacement").Vector(dimension)
                                  : Eigen::VectorXd::Zero(dimension);
  for (Eigen::Index node = 0; node < nodes.size(); ++node) {
    for (Eigen::Index axis = 0; axis < dimension && nodes[node]; ++axis) {
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
  const JsonValue selection = support.At("nodes");
  if (!selection.IsString() && selection.Has("box")) {
    const BoxCorners box = CornersOfBox(selection.At("box"), mesh);
    supports.boxes.push_back({box.low.head(dimension), box.high.head(dimension),
                              components, displacement});
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

/// The keys `model` and `thickness`.
SectionChoice ReadSection(const JsonValue& document) {
  SectionChoice choice;
  if (document.Has("model")) {
    const JsonValue model = document.At("model");
    const std::string name = model.String();
    choice.model = SectionModelOfName(name);
    if (!choice.model) {
      model.Fail("is \"" + Printable(name) + "\"; make it " + kSectionModels);
    }
  }
  if (document.Has("thickness")) {
    choice.thickness = document.At("thickness").Number();
    if (!(*choice.thickness > 0)) {
      document.At("thickness").Fail("must be positive");
    }
  }
  return choice;
}

Supports ReadSupports(const JsonValue& document, const MeshFile& mesh) {
  Supports supports;
  supports.held.setConstant(mesh.Dimension(), mesh.nodes.cols(), false);
  supports.displacement.setZero(mesh.Dimension(), mesh.nodes.cols());
  for (const JsonValue& support : document.At("supports").Items()) {
    AddSupport(support, mesh, supports);
  }
  return supports;
}

/// The numbers of components that vectors of a mesh file may have.
std::vector<Eigen::Index> VectorSizes(const MeshFile& mesh) {
  return mesh.Dimension() == 3 ? std::vector<Eigen::Index>{3}
                               : std::vector<Eigen::Index>{2, 3};
}

/// A vector per node, from the one of the keys `file` and `array` that
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
    field = ReadCsvField(file, mesh.nodes.cols(), mesh.Dimension());
    what = "the row";
  } else {
    field = NamedNodeArray(value.At("array"), mesh, VectorSizes(mesh));
    what = "the point array '" + Printable(value.At("array").String()) + "'";
  }
  return VectorField(file, what, mesh, field, mask, mend);
}

std::string ListText(const Eigen::VectorXd& values) {
  std::ostringstream text;
  for (Eigen::Index i = 0; i < values.size(); ++i) {
    text << (i == 0 ? "[" : ", ") << values[i];
  }
  text << "]";
  return text.str();
}

/// A total that is given as a nodal force would be as many times too large as
/// there are nodes, and Young's modulus with it.
void NoteForcePerNode(const JsonValue& load, const Eigen::VectorXd& value,
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
    return {ReadField(load, context.mesh, AllComponents(context.mesh),
                      "correct it")};
  }
  const Eigen::VectorXd value =
      load.At("value").Vector(context.mesh.Dimension());
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
  const auto vector = [&] {
    return load.At("value").Vector(context.mesh.Dimension());
  };
  const JsonValue type = load.At("type");
  const std::string name = type.String();
  if (name == "nodal_force") {
    return ReadNodalForces(load, context);
  }
  if (name == "body_force") {
    load.CheckKeys({"type", "value"});
    return BodyForce{vector()};
  }
  if (name == "traction") {
    load.CheckKeys({"type", "value", "surface"});
    return Traction{facets(), vector()};
  }
  if (name == "pressure") {
    load.CheckKeys({"type", "value", "surface"});
    return Pressure{facets(), load.At("value").Number()};
  }
  if (name == "force") {
    load.CheckKeys({"type", "value", "surface"});
    return SurfaceForce{facets(), vector()};
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
    std::vector<Eigen::Index> sizes = VectorSizes(mesh);
    sizes.push_back(1);
    return ToComponentMask(mesh.path,
                           "the point array '" + Printable(name.String()) + "'",
                           mesh, NamedNodeArray(name, mesh, sizes));
  }
  return SelectNodes(observed, mesh, &context.free)
      .replicate(mesh.Dimension(), 1);
}

// Points, or a vector per node.
void ReadDisplacement(const JsonValue& displacement, Context& context,
                      LoadCase& load_case) {
  if (displacement.Has("points")) {
    if (load_case.observed.size() > 0) {
      displacement.Fail(
          "names points, which \"observed\" does not choose from; leave it "
          "out");
    }
    if (!context.locator) {
      context.locator.emplace(context.scene_mesh);
    }
    load_case.points = ReadMeasuredPoints(displacement, context.scene_mesh,
                                          *context.locator, context.notices);
    return;
  }
  displacement.CheckKeys({"file", "array"});
  load_case.displacement =
      ReadField(displacement, context.mesh,
                load_case.observed.size() > 0 ? load_case.observed
                                              : AllComponents(context.mesh),
                "correct it or leave it out of the observed nodes");
  ClearUnobserved(load_case);
}

LoadCase ReadLoadCase(const JsonValue& value, Context& context,
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
    ReadDisplacement(value.At("displacement"), context, load_case);
  }
  return load_case;
}

int ReadRegion(const JsonValue& value) {
  const long long region = value.Integer();
  if (region < std::numeric_limits<int>::min() ||
      region > std::numeric_limits<int>::max()) {
    value.Fail("is out of range; give the id of a region");
  }
  return static_cast<int>(region);
}

// Numbers and bounds of parameters of a law, by their names.
void ReadWhatIsKnown(const JsonValue& value, const Law& law,
                     Material& material) {
  std::vector<std::string> names;
  for (const LawParameter& parameter : law.Parameters()) {
    names.emplace_back(parameter.name);
  }
  if (value.Has("known")) {
    value.At("known").CheckKeys(names);
  }
  if (value.Has("bounds")) {
    value.At("bounds").CheckKeys(names);
  }
  for (const std::string& name : names) {
    if (value.Has("known") && value.At("known").Has(name)) {
      material.known.push_back({name, value.At("known").At(name).Number()});
    }
    if (value.Has("bounds") && value.At("bounds").Has(name)) {
      const Eigen::VectorXd ends = value.At("bounds").At(name).Vector(2);
      material.bounds.push_back({name, {ends(0), ends(1)}});
    }
  }
}

Material ReadMaterial(const JsonValue& value) {
  value.CheckKeys({"law", "region", "known", "bounds"});
  Material material;
  if (value.Has("law")) {
    material.law = value.At("law").String();
  }
  const Law* const law = FindLaw(material.law);
  if (law == nullptr) {
    value.At("law").Fail("is \"" + Printable(material.law) +
                         "\"; the laws known here are " + LawNames());
  }
  if (value.Has("region")) {
    const JsonValue region = value.At("region");
    if (region.IsInteger()) {
      material.regions.push_back(ReadRegion(region));
    } else {
      for (const JsonValue& each : region.Items()) {
        material.regions.push_back(ReadRegion(each));
      }
      if (material.regions.empty()) {
        region.Fail("is empty; name a region, or leave it out");
      }
    }
  }
  ReadWhatIsKnown(value, *law, material);
  return material;
}

std::vector<Material> ReadMaterials(const JsonValue& document) {
  std::vector<Material> materials;
  if (document.Has("materials")) {
    for (const JsonValue& value : document.At("materials").Items()) {
      materials.push_back(ReadMaterial(value));
    }
    if (materials.empty()) {
      document.At("materials").Fail("is empty; name one, or leave it out");
    }
  }
  return materials;
}

}  // namespace

FileScene ReadJsonScene(const std::filesystem::path& path,
                        Measurement measurement, const SectionChoice& section) {
  const nlohmann::json parsed = ParseJsonFile(path);
  const JsonValue document(path, parsed);
  document.CheckKeys(
      {"model", "thickness", "mesh", "materials", "supports", "cases"});
  const SectionChoice choice = Choose(section, ReadSection(document));
  FileScene file_scene;
  file_scene.mesh = ReadNamedMesh(document.At("mesh"));
  const MeshFile& mesh = file_scene.mesh;
  file_scene.scene.mesh =
      SceneMesh(mesh, SectionOf(mesh, choice), mesh.elements);
  file_scene.scene.materials = ReadMaterials(document);
  file_scene.scene.supports = ReadSupports(document, mesh);
  Context context = {
      mesh,
      !file_scene.scene.supports.held.colwise().all() && mesh.used,
      BoundaryFacets(file_scene.scene.mesh),
      file_scene.scene.mesh,
      {},
      file_scene.notices};
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
