#include "elastimate/io/scene/node_selection.h"

#include <algorithm>
#include <cmath>
#include <set>
#include <string>
#include <vector>

#include "elastimate/core/text/numbers.h"
#include "elastimate/io/mesh/surface_facets.h"
#include "elastimate/io/text/printable.h"

namespace elastimate {
namespace {

void SelectIds(const JsonValue& ids, const MeshFile& mesh, NodeMask& mask) {
  RequireNodePositions(mesh);
  for (const JsonValue& id : ids.Items()) {
    const long long node = id.Integer();
    if (node < 0 || node >= mesh.nodes.cols()) {
      id.Fail("is " + std::to_string(node) + ", but the mesh has the nodes 0 " +
              "to " + std::to_string(mesh.nodes.cols() - 1) +
              "; correct the id");
    }
    mask[node] = true;
  }
}

void SelectBox(const JsonValue& box, const MeshFile& mesh, NodeMask& mask) {
  const auto [low, high] = CornersOfBox(box, mesh);
  const auto contains = [&, low = low, high = high](const auto& position) {
    const auto x = position.head(low.size()).array();
    return (x >= low.array()).all() && (x <= high.array()).all();
  };
  for (Eigen::Index node = 0; node < mesh.nodes.cols(); ++node) {
    mask[node] = contains(mesh.nodes.col(node));
  }
  // A box is meant for the positions of the file.
  for (const auto& [node, in_file] : mesh.moved) {
    mask[node] = mask[node] || contains(in_file);
  }
}

void SelectByArray(const JsonValue& name, const MeshFile& mesh,
                   NodeMask& mask) {
  const Eigen::MatrixXd& values = NamedNodeArray(name, mesh, {1});
  for (Eigen::Index node = 0; node < values.cols(); ++node) {
    if (mesh.used[node] && std::isnan(values(0, node))) {
      name.Fail("names the array '" + Printable(name.String()) +
                "', which is nan at " + NodeName(mesh, node) + "; correct it");
    }
  }
  mask = values.row(0).array() != 0;
  FlagAddedNodes(mesh, mask);
}

std::string GroupNames(const MeshFile& mesh) {
  std::set<std::string> names;
  std::string list;
  for (const PhysicalGroup& group : mesh.groups) {
    std::string name =
        mesh.sets_of.empty() ? std::to_string(group.number) + " " : "";
    name += group.name.empty() ? "" : "\"" + Printable(group.name) + "\"";
    name.erase(name.find_last_not_of(' ') + 1);
    if (names.insert(name).second) {
      list += (list.empty() ? "" : ", ") + name;
    }
  }
  return list.empty() ? "none" : list;
}

/// Returns the groups of that name or number; there are several when they
/// differ in dimension.
std::vector<const PhysicalGroup*> FindGroups(const JsonValue& name,
                                             const MeshFile& mesh) {
  const std::string group_word =
      mesh.sets_of.empty() ? "physical group" : "set";
  if (!name.IsString() && (!name.IsInteger() || !mesh.sets_of.empty())) {
    name.Fail("must be the name " +
              std::string(mesh.sets_of.empty() ? "or the number " : "") +
              "of a " + group_word);
  }
  const std::string wanted =
      name.IsString() ? name.String() : std::to_string(name.Integer());
  std::vector<const PhysicalGroup*> groups;
  for (const PhysicalGroup& group : mesh.groups) {
    if (AreSameNames(mesh, group.name, wanted) ||
        (mesh.sets_of.empty() && std::to_string(group.number) == wanted)) {
      groups.push_back(&group);
    }
  }
  if (groups.empty()) {
    name.Fail("names no " + group_word + " of '" + PrintablePath(mesh.path) +
              "'; its " + (mesh.sets_of.empty() ? "groups" : "sets") +
              " are: " + GroupNames(mesh));
  }
  return groups;
}

/// Returns the value of the key "physical" or "set".
JsonValue GroupName(const JsonValue& selection) {
  return selection.At(selection.Has("set") ? "set" : "physical");
}

/// Selects the nodes of the groups of a name or number.  The elements at a face
/// often make up a set with the name of that of its nodes, which is meant then.
void SelectGroups(const JsonValue& name, const MeshFile& mesh, NodeMask& mask) {
  const std::vector<const PhysicalGroup*> groups = FindGroups(name, mesh);
  int lowest = 3;
  for (const PhysicalGroup* group : groups) {
    lowest = std::min(lowest, group->dimension);
  }
  for (const PhysicalGroup* group : groups) {
    if (mesh.sets_of.empty() || group->dimension == lowest) {
      mask(group->nodes).setConstant(true);
    }
  }
}

/// Finds, for each facet of the group, the boundary facet of the same vertices.
void MatchFacets(const JsonValue& selection, const MeshFile& mesh,
                 const PhysicalGroup& group, const Eigen::MatrixXi& boundary,
                 std::vector<Eigen::Index>& chosen) {
  const SurfaceFacets facets(boundary, mesh.Topology().NumVerticesOfFace());
  for (Eigen::Index i = 0; i < group.facets.cols(); ++i) {
    const Eigen::Index place = facets.Find(group.facets.col(i));
    if (place < 0) {
      const bool is_solid = mesh.Dimension() == 3;
      const std::string facet = !is_solid ? "edge "
                                : mesh.Topology().NumVerticesOfFace() == 3
                                    ? "triangle "
                                    : "quadrilateral ";
      selection.Fail(std::string("names a ") +
                     (mesh.sets_of.empty() ? "physical group" : "set") +
                     " whose " + facet + std::to_string(i) + " is not " +
                     (is_solid ? "a face" : "an edge") +
                     " on the boundary of the " + mesh.Shapes());
    }
    chosen.push_back(place);
  }
}

/// Returns the groups of facets that `selection` names, if it names any.
std::vector<const PhysicalGroup*> FindSurfaceGroups(const JsonValue& selection,
                                                    const MeshFile& mesh) {
  std::vector<const PhysicalGroup*> groups;
  if (!selection.IsString() &&
      (selection.Has("physical") || selection.Has("set"))) {
    groups = FindGroups(GroupName(selection), mesh);
    groups.erase(std::remove_if(groups.begin(), groups.end(),
                                [](const PhysicalGroup* group) {
                                  return group->facets.cols() == 0;
                                }),
                 groups.end());
  }
  return groups;
}

// Returns "(0, 0) and (20, 5)", the corners of the box of all nodes.
std::string CornersOf(const MeshFile& mesh) {
  const auto text_of = [&mesh](const Eigen::VectorXd& corner) {
    std::string text;
    for (int i = 0; i < DimensionOf(mesh.kind); ++i) {
      text += (text.empty() ? "(" : ", ") + NumberText(corner(i));
    }
    return text + ")";
  };
  return text_of(mesh.nodes.rowwise().minCoeff()) + " and " +
         text_of(mesh.nodes.rowwise().maxCoeff());
}

}  // namespace

BoxCorners CornersOfBox(const JsonValue& box, const MeshFile& mesh) {
  const std::vector<JsonValue> corners = box.Items();
  if (corners.size() != 2) {
    box.Fail(mesh.Dimension() == 3 ? "must be two corners, [[x,y,z],[x,y,z]]"
                                   : "must be two corners, [[x,y],[x,y]]");
  }
  const Eigen::Index size =
      corners[0].ListSize() == 3 ? 3 : Eigen::Index{mesh.Dimension()};
  BoxCorners box_corners = {corners[0].Vector(size), corners[1].Vector(size)};
  if ((box_corners.low.array() > box_corners.high.array()).any()) {
    box.Fail(
        "has a first corner that is above the second one in some direction; "
        "give the smallest coordinates first");
  }
  return box_corners;
}

NodeMask SelectNodes(const JsonValue& selection, const MeshFile& mesh,
                     const NodeMask* free) {
  NodeMask mask = NodeMask::Constant(mesh.nodes.cols(), false);
  if (selection.IsString()) {
    const std::string word = selection.String();
    if (word == "all") {
      mask.setConstant(true);
    } else if (word == "free" && free != nullptr) {
      mask = *free;
      if (!mask.any()) {
        selection.Fail(
            "is \"free\", but the supports hold every node; choose other "
            "nodes");
      }
    } else if (word == "free") {
      selection.Fail(
          "is \"free\", which cannot be used here; choose \"all\" or other "
          "nodes");
    } else {
      selection.Fail("is \"" + Printable(word) +
                     "\"; the words known here are \"all\" " + "and \"free\"");
    }
  } else {
    selection.CheckKeys({"ids", "box", "array", "physical", "set"});
    if (selection.NumKeys() != 1) {
      selection.Fail(
          "must have exactly one of the keys ids, box, array, physical, set");
    }
    if (selection.Has("ids")) {
      SelectIds(selection.At("ids"), mesh, mask);
    } else if (selection.Has("box")) {
      SelectBox(selection.At("box"), mesh, mask);
    } else if (selection.Has("array")) {
      SelectByArray(selection.At("array"), mesh, mask);
    } else {
      SelectGroups(GroupName(selection), mesh, mask);
    }
  }
  mask = mask && mesh.used;
  if (!mask.any()) {
    selection.Fail("selects no node that a " + mesh.Shape() +
                   " uses; correct it: the nodes lie between " +
                   CornersOf(mesh));
  }
  return mask;
}

Eigen::MatrixXi SelectFacets(const JsonValue& selection, const MeshFile& mesh,
                             const NodeMask& free,
                             const Eigen::MatrixXi& boundary) {
  const NodeMask mask = SelectNodes(selection, mesh, &free);
  std::vector<Eigen::Index> chosen;
  const std::vector<const PhysicalGroup*> groups =
      FindSurfaceGroups(selection, mesh);
  for (const PhysicalGroup* group : groups) {
    MatchFacets(selection, mesh, *group, boundary, chosen);
  }
  if (groups.empty()) {
    for (Eigen::Index facet = 0; facet < boundary.cols(); ++facet) {
      if (mask(boundary.col(facet)).all()) {
        chosen.push_back(facet);
      }
    }
  }
  std::sort(chosen.begin(), chosen.end());
  chosen.erase(std::unique(chosen.begin(), chosen.end()), chosen.end());
  if (chosen.empty()) {
    selection.Fail(
        "selects no whole facet of the surface; choose all nodes of a facet at "
        "least");
  }
  return boundary(Eigen::all, chosen);
}

const Eigen::MatrixXd& NamedNodeArray(
    const JsonValue& name, const MeshFile& mesh,
    const std::vector<Eigen::Index>& components) {
  const Eigen::MatrixXd* array = FindArray(mesh.node_arrays, name.String());
  if (array == nullptr) {
    name.Fail("names the array '" + Printable(name.String()) + "', which '" +
              PrintablePath(mesh.path) +
              "' does not have; its point arrays are: " +
              ArrayNames(mesh.node_arrays));
  }
  if (std::find(components.begin(), components.end(), array->rows()) ==
      components.end()) {
    std::string due;
    for (const Eigen::Index count : components) {
      due += (due.empty() ? "" : " or ") + std::to_string(count);
    }
    name.Fail("names the array '" + Printable(name.String()) + "', which has " +
              std::to_string(array->rows()) + " components where " + due +
              " are due");
  }
  return *array;
}

}  // namespace elastimate
