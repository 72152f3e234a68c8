#include "elastimate/io/scene/json_supports.h"

#include <algorithm>
#include <string>

#include "elastimate/core/mesh/axis_names.h"
#include "elastimate/io/scene/node_selection.h"
#include "elastimate/io/text/printable.h"

namespace elastimate {
namespace {

using Components = Eigen::Array<bool, Eigen::Dynamic, 1>;

/// What a support says about the displacement.
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

/// What the supports before the present one hold.
struct HeldSoFar {
  Supports supports;
  /// The last support that holds each component, -1 where none does.
  Eigen::ArrayXXi holder;
};

/// Tells whether a support says the same about a component as those before it.
bool IsHeldAlike(const HeldSoFar& so_far, Eigen::Index axis, Eigen::Index node,
                 const SupportDisplacement& displacement) {
  const Supports& supports = so_far.supports;
  if (displacement.IsUnknown() || supports.unknown(axis, node)) {
    // Faces that move by themselves never say the same.
    const auto is_of = [&](const RigidFace& face) {
      return face.components(axis) &&
             std::binary_search(face.nodes.begin(), face.nodes.end(), node);
    };
    return displacement.is_measured && supports.unknown(axis, node) &&
           std::none_of(supports.rigid_faces.begin(),
                        supports.rigid_faces.end(), is_of);
  }
  return supports.displacement(axis, node) == displacement.given(axis);
}

void AddSupport(const JsonValue& support, int number, const MeshFile& mesh,
                HeldSoFar& so_far) {
  Supports& supports = so_far.supports;
  support.CheckKeys({"nodes", "components", "displacement"});
  const NodeMask nodes = SelectNodes(support.At("nodes"), mesh, nullptr);
  const int dimension = mesh.Dimension();
  const Components components = ReadComponents(support, dimension);
  const SupportDisplacement displacement =
      ReadSupportDisplacement(support, dimension);
  const JsonValue selection = support.At("nodes");
  const bool is_group = !selection.IsString() &&
                        (selection.Has("physical") || selection.Has("set"));
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
      const int holder = so_far.holder(axis, node);
      if (holder >= 0 && !IsHeldAlike(so_far, axis, node, displacement)) {
        support.Fail("holds the " + std::string(kAxisNames[axis]) +
                     " component of " + NodeName(mesh, node) +
                     " differently from supports[" + std::to_string(holder) +
                     "]; leave the node out of one of them");
      }
      // A support that ends with its nodes may go on in another one.
      supports.delimited(axis, node) =
          is_group && (holder < 0 || supports.delimited(axis, node));
      so_far.holder(axis, node) = number;
      supports.held(axis, node) = true;
      supports.unknown(axis, node) = displacement.IsUnknown();
      supports.displacement(axis, node) = displacement.given(axis);
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
  HeldSoFar so_far;
  Supports& supports = so_far.supports;
  supports.held.setConstant(mesh.Dimension(), mesh.nodes.cols(), false);
  supports.unknown = supports.held;
  supports.delimited = supports.held;
  supports.displacement.setZero(mesh.Dimension(), mesh.nodes.cols());
  so_far.holder.setConstant(mesh.Dimension(), mesh.nodes.cols(), -1);
  int number = 0;
  for (const JsonValue& support : document.At("supports").Items()) {
    AddSupport(support, number++, mesh, so_far);
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
