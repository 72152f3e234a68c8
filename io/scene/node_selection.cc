#include "elastimate/io/scene/node_selection.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <string>
#include <vector>

#include "elastimate/io/text/printable.h"

namespace elastimate {
namespace {

void SelectIds(const JsonValue& ids, const MeshFile& mesh, NodeMask& mask) {
  RequireNodePositions(mesh);
  for (const JsonValue& id : ids.Items()) {
    const long long node = id.Integer();
    if (node < 0 || node >= mesh.nodes.cols()) {
      id.Fail("is " + std::to_string(node) + ", but the mesh has the nodes 0 " +
              "to " + std::to_string(mesh.nodes.cols() - 1));
    }
    mask[node] = true;
  }
}

void SelectBox(const JsonValue& box, const MeshFile& mesh, NodeMask& mask) {
  const std::vector<JsonValue> corners = box.Items();
  if (corners.size() != 2) {
    box.Fail("must be two corners, [[x,y,z],[x,y,z]]");
  }
  const Eigen::Vector3d low = corners[0].Vector();
  const Eigen::Vector3d high = corners[1].Vector();
  if ((low.array() > high.array()).any()) {
    box.Fail("has a first corner above its second one; swap them");
  }
  for (Eigen::Index node = 0; node < mesh.nodes.cols(); ++node) {
    const auto position = mesh.nodes.col(node).array();
    mask[node] =
        (position >= low.array()).all() && (position <= high.array()).all();
  }
}

void SelectByArray(const JsonValue& name, const MeshFile& mesh,
                   NodeMask& mask) {
  const Eigen::MatrixXd& values = NamedNodeArray(name, mesh, 1);
  for (Eigen::Index node = 0; node < values.cols(); ++node) {
    if (mesh.used[node] && std::isnan(values(0, node))) {
      name.Fail("names the array '" + Printable(name.String()) +
                "', which is nan at " + NodeName(mesh, node));
    }
  }
  mask = values.row(0).array() != 0;
}

std::string GroupNames(const MeshFile& mesh) {
  std::string names;
  for (const PhysicalGroup& group : mesh.groups) {
    names += (names.empty() ? "" : ", ") + std::to_string(group.number);
    if (!group.name.empty()) {
      names += " \"" + Printable(group.name) + "\"";
    }
  }
  return names.empty() ? "none" : names;
}

/// The groups of that name or number; more than one when they differ in
/// dimension.
std::vector<const PhysicalGroup*> FindGroups(const JsonValue& name,
                                             const MeshFile& mesh) {
  if (!name.IsString() && !name.IsInteger()) {
    name.Fail("must be the name or the number of a physical group");
  }
  const std::string wanted =
      name.IsString() ? name.String() : std::to_string(name.Integer());
  std::vector<const PhysicalGroup*> groups;
  for (const PhysicalGroup& group : mesh.groups) {
    if (group.name == wanted || std::to_string(group.number) == wanted) {
      groups.push_back(&group);
    }
  }
  if (groups.empty()) {
    name.Fail("names no physical group of '" + PrintablePath(mesh.path) +
              "'; its groups are: " + GroupNames(mesh));
  }
  return groups;
}

std::array<int, 3> SortedNodes(const Eigen::MatrixXi& facets,
                               Eigen::Index facet) {
  std::array<int, 3> nodes = {facets(0, facet), facets(1, facet),
                              facets(2, facet)};
  std::sort(nodes.begin(), nodes.end());
  return nodes;
}

/// Each triangle of the group as the boundary facet of the same nodes.
void MatchTriangles(const JsonValue& selection, const PhysicalGroup& group,
                    const Eigen::MatrixXi& boundary,
                    std::vector<Eigen::Index>& chosen) {
  std::map<std::array<int, 3>, Eigen::Index> facets;
  for (Eigen::Index facet = 0; facet < boundary.cols(); ++facet) {
    facets.emplace(SortedNodes(boundary, facet), facet);
  }
  for (Eigen::Index i = 0; i < group.triangles.cols(); ++i) {
    const auto found = facets.find(SortedNodes(group.triangles, i));
    if (found == facets.end()) {
      selection.Fail("names a physical group whose triangle " +
                     std::to_string(i) +
                     " is not a face on the boundary of the tetrahedra");
    }
    chosen.push_back(found->second);
  }
}

/// The groups of triangles that `selection` names, if it names any.
std::vector<const PhysicalGroup*> FindSurfaceGroups(const JsonValue& selection,
                                                    const MeshFile& mesh) {
  std::vector<const PhysicalGroup*> groups;
  if (!selection.IsString() && selection.Has("physical")) {
    groups = FindGroups(selection.At("physical"), mesh);
    groups.erase(std::remove_if(groups.begin(), groups.end(),
                                [](const PhysicalGroup* group) {
                                  return group->triangles.cols() == 0;
                                }),
                 groups.end());
  }
  return groups;
}

}  // namespace

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
        selection.Fail("is \"free\", but the supports hold every node");
      }
    } else if (word == "free") {
      selection.Fail("is \"free\", which cannot be used here");
    } else {
      selection.Fail("is \"" + Printable(word) +
                     "\"; the words known here are \"all\" " + "and \"free\"");
    }
  } else {
    selection.CheckKeys({"ids", "box", "array", "physical"});
    if (selection.NumKeys() != 1) {
      selection.Fail(
          "must have exactly one of the keys ids, box, array, "
          "physical");
    }
    if (selection.Has("ids")) {
      SelectIds(selection.At("ids"), mesh, mask);
    } else if (selection.Has("box")) {
      SelectBox(selection.At("box"), mesh, mask);
    } else if (selection.Has("array")) {
      SelectByArray(selection.At("array"), mesh, mask);
    } else {
      for (const PhysicalGroup* group :
           FindGroups(selection.At("physical"), mesh)) {
        mask(group->nodes).setConstant(true);
      }
    }
  }
  mask = mask && mesh.used;
  if (!mask.any()) {
    selection.Fail("selects no node that a tetrahedron uses");
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
    MatchTriangles(selection, *group, boundary, chosen);
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
    selection.Fail("selects no whole facet of the surface");
  }
  return boundary(Eigen::all, chosen);
}

const Eigen::MatrixXd& NamedNodeArray(const JsonValue& name,
                                      const MeshFile& mesh, int components,
                                      int other_components) {
  const Eigen::MatrixXd* array = FindArray(mesh.node_arrays, name.String());
  if (array == nullptr) {
    name.Fail("names the array '" + Printable(name.String()) + "', which '" +
              PrintablePath(mesh.path) + "' does not have");
  }
  if (array->rows() != components && array->rows() != other_components) {
    name.Fail("names the array '" + Printable(name.String()) + "', which has " +
              std::to_string(array->rows()) + " components where " +
              std::to_string(components) +
              (other_components == 0
                   ? ""
                   : " or " + std::to_string(other_components)) +
              " are due");
  }
  return *array;
}

}  // namespace elastimate
