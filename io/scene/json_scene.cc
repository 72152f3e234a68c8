#include "elastimate/io/scene/json_scene.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <sstream>
#include <string>
#include <utility>
#include <vector>

#include "elastimate/core/materials/laws.h"
#include "elastimate/core/mesh/axis_names.h"
#include "elastimate/io/points/point_locator.h"
#include "elastimate/io/scene/csv_field.h"
#include "elastimate/io/scene/json_supports.h"
#include "elastimate/io/scene/json_value.h"
#include "elastimate/io/scene/measured_mesh.h"
#include "elastimate/io/scene/measured_points.h"
#include "elastimate/io/scene/mesh_reader.h"
#include "elastimate/io/scene/node_selection.h"
#include "elastimate/io/scene/section.h"
#include "elastimate/io/text/input_error.h"
#include "elastimate/io/text/printable.h"

namespace elastimate {
namespace {

constexpr double kNotMeasured = std::numeric_limits<double>::quiet_NaN();

/// What the load cases of one document are read against.
struct Context {
  const MeshFile& mesh;
  NodeMask free;             ///< Nodes with a component that is not held.
  Eigen::MatrixXi boundary;  ///< BoundaryFacets.
  const Supports& supports;
  bool is_mesh_measured;  ///< Its nodes are measured points.
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

MeshFile ReadNamedMesh(const JsonValue& name,
                       std::vector<std::string>& notices) {
  if (name.IsObject()) {
    return ReadMeasuredMesh(name, notices);
  }
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
            "traction, pressure, resultant");
}

/// A force that no support exerts is a load.
void RequireHeld(const JsonValue& value, const Context& context,
                 const Resultant& resultant) {
  for (Eigen::Index i = 0; i < resultant.force.size(); ++i) {
    const bool is_held =
        std::any_of(resultant.nodes.begin(), resultant.nodes.end(),
                    [&](int node) { return context.supports.held(i, node); });
    if (!std::isnan(resultant.force(i)) && !is_held) {
      value.Fail("measures the force along " + std::string(kAxisNames[i]) +
                 " of a surface that no support holds there, so that nothing "
                 "exerts it; give it as a load of type \"force\", or hold the "
                 "surface (\"displacement\": \"measured\" or \"rigid\")");
    }
  }
}

/// A force with null where it was not measured, and its standard deviation.
Resultant ReadResultant(const JsonValue& value, const Context& context) {
  value.CheckKeys({"type", "value", "surface", "sd", "relative_sd"});
  const int dimension = context.mesh.Dimension();
  const JsonValue components = value.At("value");
  if (components.ListSize() != dimension) {
    components.Fail("must be a list of " + std::to_string(dimension) +
                    " numbers, with null where it was not measured");
  }
  Resultant resultant;
  resultant.force.setConstant(dimension, kNotMeasured);
  double square_sum = 0;
  for (int i = 0; i < dimension; ++i) {
    const JsonValue component = components.Items()[i];
    if (!component.IsNull()) {
      resultant.force(i) = component.Number();
      square_sum += resultant.force(i) * resultant.force(i);
    }
  }
  if (resultant.force.array().isNaN().all()) {
    components.Fail("has no number; give a component that was measured");
  }
  if (value.Has("sd") == value.Has("relative_sd")) {
    value.Fail(
        "must have exactly one of the keys sd, relative_sd: how well the load "
        "cell knows the force");
  }
  const JsonValue sd = value.At(value.Has("sd") ? "sd" : "relative_sd");
  const double scale = value.Has("sd") ? 1 : std::sqrt(square_sum);
  if (!(sd.Number() > 0)) {
    sd.Fail("must be positive");
  }
  if (!(scale > 0)) {
    sd.Fail("is relative to a force of zero; give sd, in units of force");
  }
  resultant.noise_sd.setConstant(dimension, scale * sd.Number());
  const NodeMask nodes =
      SelectNodes(value.At("surface"), context.mesh, nullptr);
  for (int node = 0; node < nodes.size(); ++node) {
    if (nodes[node]) {
      resultant.nodes.push_back(node);
    }
  }
  RequireHeld(value, context, resultant);
  return resultant;
}

void ReadLoads(const JsonValue& loads, const Context& context,
               LoadCase& load_case) {
  for (const JsonValue& load : loads.Items()) {
    const JsonValue type = load.At("type");
    if (type.IsString() && type.String() == "resultant") {
      load_case.resultants.push_back(ReadResultant(load, context));
    } else {
      load_case.loads.push_back(ReadLoad(load, context));
    }
  }
}

bool ReadIsRigidMotionFree(const JsonValue& document) {
  if (!document.Has("rigid_motion")) {
    return false;
  }
  const JsonValue value = document.At("rigid_motion");
  if (value.String() != "free") {
    value.Fail("is \"" + Printable(value.String()) +
               "\"; make it \"free\", or leave it out");
  }
  return true;
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
  ReadLoads(value.At("loads"), context, load_case);
  if (value.Has("noise_sd")) {
    load_case.noise_sd = value.At("noise_sd").Number();
    if (!(*load_case.noise_sd > 0)) {
      value.At("noise_sd").Fail("must be positive");
    }
  }
  if (value.Has("observed")) {
    load_case.observed = ReadObserved(value.At("observed"), context);
  }
  if (!value.Has("displacement") && context.is_mesh_measured) {
    load_case.displacement =
        *FindArray(context.mesh.node_arrays, "displacement");
  } else if (value.Has("displacement") ||
             measurement == Measurement::kRequired) {
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
  document.CheckKeys({"model", "thickness", "mesh", "materials", "supports",
                      "rigid_motion", "cases"});
  const SectionChoice choice = Choose(section, ReadSection(document));
  FileScene file_scene;
  file_scene.mesh = ReadNamedMesh(document.At("mesh"), file_scene.notices);
  const MeshFile& mesh = file_scene.mesh;
  file_scene.scene.mesh =
      SceneMesh(mesh, SectionOf(mesh, choice), mesh.elements);
  file_scene.scene.materials = ReadMaterials(document);
  file_scene.scene.supports = ReadSupports(document, mesh);
  file_scene.scene.is_rigid_motion_free = ReadIsRigidMotionFree(document);
  Context context = {
      mesh,
      !file_scene.scene.supports.held.colwise().all() && mesh.used,
      BoundaryFacets(file_scene.scene.mesh),
      file_scene.scene.supports,
      document.At("mesh").IsObject(),
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
