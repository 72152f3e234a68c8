#include "elastimate/io/scene/json_loads.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <sstream>

#include "elastimate/core/mesh/axis_names.h"
#include "elastimate/io/scene/file_scene.h"
#include "elastimate/io/scene/node_field.h"
#include "elastimate/io/text/printable.h"

namespace elastimate {
namespace {

constexpr double kNotMeasured = std::numeric_limits<double>::quiet_NaN();

std::string ListText(const Eigen::VectorXd& values) {
  std::ostringstream text;
  for (Eigen::Index i = 0; i < values.size(); ++i) {
    text << (i == 0 ? "[" : ", ") << values[i];
  }
  text << "]";
  return text.str();
}

/// Notes a total that is given as a nodal force, which would be as many times
/// too large as there are nodes, and Young's modulus with it.
void NoteForcePerNode(const JsonValue& load, const Eigen::VectorXd& value,
                      Eigen::Index num_nodes, const LoadContext& context) {
  const JsonValue nodes = load.At("nodes");
  const bool names_a_part = !nodes.IsString() && !nodes.Has("ids");
  if (!names_a_part || num_nodes == 1 || value.isZero(0)) {
    return;
  }
  context.notices.push_back(
      PrintablePath(load.File()) + ": " + load.Place() +
      " is a nodal_force, which acts on each node: " + ListText(value) +
      (num_nodes == 1
           ? " on 1 node, "
           : " on each of " + std::to_string(num_nodes) + " nodes, ") +
      ListText(static_cast<double>(num_nodes) * value) + " in total; if " +
      ListText(value) +
      " is the total, give it as \"type\": \"force\" with a \"surface\"");
}

NodalForces ReadNodalForces(const JsonValue& load, const LoadContext& context) {
  load.CheckKeys({"type", "value", "nodes", "file", "array"});
  if (load.Has("file") || load.Has("array")) {
    if (load.Has("value") || load.Has("nodes")) {
      load.Fail(
          "must have either \"value\" and \"nodes\", or one of \"file\" and "
          "\"array\"");
    }
    NodalForces forces = {ReadNodeField(
        load, context.mesh, AllComponents(context.mesh), "correct it")};
    forces.force.rightCols(Eigen::Index(context.mesh.added.size())).setZero();
    return forces;
  }
  const Eigen::VectorXd value =
      load.At("value").Vector(context.mesh.Dimension());
  const NodeMask nodes =
      SelectNodes(load.At("nodes"), context.mesh, &context.free);
  NoteForcePerNode(load, value, nodes.count(), context);
  return {value * nodes.cast<double>().matrix()};
}

Load ReadLoad(const JsonValue& load, const LoadContext& context) {
  const auto facets = [&] {
    return SelectFacets(load.At("surface"), context.mesh, context.free,
                        context.boundary);
  };
  const auto vector = [&] {
    return load.At("value").Vector(context.mesh.Dimension());
  };
  const JsonValue type = load.At("type");
  const std::string name = type.String();
  if (load.Has("follows") && name != "pressure") {
    load.At("follows").Fail(
        "is for loads of the type pressure only; other loads keep their "
        "direction, so leave it out");
  }
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
    load.CheckKeys({"type", "value", "surface", "follows"});
    return Pressure{facets(), load.At("value").Number(),
                    load.Has("follows") && load.At("follows").Boolean()};
  }
  if (name == "force") {
    load.CheckKeys({"type", "value", "surface"});
    return SurfaceForce{facets(), vector()};
  }
  type.Fail("is \"" + Printable(name) +
            "\"; the types known here are force, nodal_force, body_force, "
            "traction, pressure, resultant");
}

/// Throws for a force that no support exerts, which is a load.
void RequireHeld(const JsonValue& value, const LoadContext& context,
                 const Resultant& resultant) {
  for (Eigen::Index i = 0; i < resultant.force.size(); ++i) {
    const auto num_held = std::count_if(
        resultant.nodes.begin(), resultant.nodes.end(),
        [&](int node) { return context.supports->held(i, node); });
    if (!std::isnan(resultant.force(i)) && num_held > 0 &&
        num_held < std::ptrdiff_t(resultant.nodes.size())) {
      value.Fail("measures the force along " + std::string(kAxisNames[i]) +
                 " of a surface of " + std::to_string(resultant.nodes.size()) +
                 " nodes, of which supports hold " + std::to_string(num_held) +
                 " there; hold all of them, or make the surface smaller");
    }
    if (!std::isnan(resultant.force(i)) && num_held == 0) {
      value.Fail(
          "measures the force along " + std::string(kAxisNames[i]) +
          " of a surface that no support holds there, so that nothing exerts "
          "this force; give it as a load of type \"force\", or hold the "
          "surface (\"displacement\": \"measured\" or \"rigid\")");
    }
  }
}

/// Reads a force, with null where it was not measured, and its standard
/// deviation.
Resultant ReadResultant(const JsonValue& value, const LoadContext& context) {
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
        "must have exactly one of the keys \"sd\" and \"relative_sd\", the "
        "standard deviation of the measured force");
  }
  const JsonValue sd = value.At(value.Has("sd") ? "sd" : "relative_sd");
  const double scale = value.Has("sd") ? 1 : std::sqrt(square_sum);
  if (!(sd.Number() > 0)) {
    sd.Fail("must be positive");
  }
  if (!(scale > 0)) {
    sd.Fail(
        "is relative to a force of zero; give \"sd\" in units of force "
        "instead");
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

}  // namespace

LoadContext::LoadContext(const MeshFile& mesh_file, const Mesh& scene_mesh,
                         const Supports& supports_of_scene,
                         std::vector<std::string>& notices_of_scene)
    : mesh(mesh_file),
      boundary(BoundaryFacets(scene_mesh)),
      notices(notices_of_scene) {
  SetSupports(&supports_of_scene);
}

void LoadContext::SetSupports(const Supports* of_case) {
  supports = of_case;
  free = !of_case->held.colwise().all() && mesh.used;
}

void ReadLoads(const JsonValue& loads, const LoadContext& context,
               LoadCase& load_case) {
  for (const JsonValue& load : loads.Items()) {
    if (IsResultant(load)) {
      load_case.resultants.push_back(ReadResultant(load, context));
    } else {
      load_case.loads.push_back(ReadLoad(load, context));
    }
  }
}

bool IsResultant(const JsonValue& load) {
  const JsonValue type = load.At("type");
  return type.IsString() && type.String() == "resultant";
}

}  // namespace elastimate
