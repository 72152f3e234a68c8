#include "elastimate/io/scene/json_supports.h"

#include <string>

#include "elastimate/core/mesh/axis_names.h"
#include "elastimate/io/scene/node_selection.h"
#include "elastimate/io/text/printable.h"

namespace elastimate {
namespace {

using Components = Eigen::Array<bool, Eigen::Dynamic, 1>;

/// What a support says of the displacement.
struct SupportDisplacement {
  Eigen::VectorXd given;  ///< Zero where it is not known.
  bool is_measured = false;
  bool is_rigid = false;

  bool IsUnknown() const { return is_measured || is_rigid; }
};

/// The components that e.g. "xz" names.
Components ReadComponents(const JsonValue& support, int dimension) {
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

SupportDisplacement ReadSupportDisplacement(const JsonValue& support,
                                            int dimension) {
  SupportDisplacement displacement = {Eigen::VectorXd::Zero(dimension)};
  if (!support.Has("displacement")) {
    return displacement;
  }
  const JsonValue value = support.At("displacement");
  if (!value.IsString()) {
    displacement.given = value.Vector(dimension);
    return displacement;
  }
  const std::string word = value.String();
  displacement.is_measured = word == "measured";
  displacement.is_rigid = word == "rigid";
  if (!displacement.IsUnknown()) {
    value.Fail("is \"" + Printable(word) +
               "\"; make it \"measured\", \"rigid\" or a vector");
  }
  return displacement;
}

// Whether the supports before this one hold a component otherwise.
bool IsContradicted(const Supports& supports, Eigen::Index axis,
                    Eigen::Index node,
                    const SupportDisplacement& displacement) {
  return supports.held(axis, node) &&
         (displacement.is_rigid || supports.unknown(axis, node) ||
          displacement.is_measured ||
          supports.displacement(axis, node) != displacement.given(axis));
}

void AddSupport(const JsonValue& support, const MeshFile& mesh,
                Supports& supports) {
  support.CheckKeys({"nodes", "components", "displacement"});
  const NodeMask nodes = SelectNodes(support.At("nodes"), mesh, nullptr);
  const int dimension = mesh.Dimension();
  const Components components = ReadComponents(support, dimension);
  const SupportDisplacement displacement =
      ReadSupportDisplacement(support, dimension);
  const JsonValue selection = support.At("nodes");
  const bool is_group = !selection.IsString() && selection.Has("physical");
  RigidFace face = {{}, components};
  for (int node = 0; node < nodes.size(); ++node) {
    if (!nodes[node]) {
      continue;
    }
    face.nodes.push_back(node);
    for (Eigen::Index axis = 0; axis < dimension; ++axis) {
      if (!components[axis]) {
        continue;
      }
      if (IsContradicted(supports, axis, node, displacement)) {
        support.Fail("holds the " + std::string(kAxisNames[axis]) +
                     " component of " + NodeName(mesh, node) +
                     " at another displacement than a support before it; "
                     "select each only once");
      }
      supports.held(axis, node) = true;
      supports.unknown(axis, node) = displacement.IsUnknown();
      supports.displacement(axis, node) = displacement.given(axis);
      supports.delimited(axis, node) = is_group;
    }
  }
  if (displacement.is_rigid) {
    supports.rigid_faces.push_back(face);
  }
  if (!displacement.IsUnknown() && !selection.IsString() &&
      selection.Has("box")) {
    const BoxCorners box = CornersOfBox(selection.At("box"), mesh);
    supports.boxes.push_back({box.low.head(dimension), box.high.head(dimension),
                              components, displacement.given});
  }
}

}  // namespace

Supports ReadSupports(const JsonValue& document, const MeshFile& mesh) {
  Supports supports;
  supports.held.setConstant(mesh.Dimension(), mesh.nodes.cols(), false);
  supports.unknown = supports.held;
  supports.delimited = supports.held;
  supports.displacement.setZero(mesh.Dimension(), mesh.nodes.cols());
  for (const JsonValue& support : document.At("supports").Items()) {
    AddSupport(support, mesh, supports);
  }
  if (!supports.unknown.any()) {
    supports.unknown.resize(0, 0);
  }
  if (!supports.delimited.any()) {
    supports.delimited.resize(0, 0);
  }
  return supports;
}

}  // namespace elastimate
