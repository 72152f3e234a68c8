#include "elastimate/io/scene/first_scene.h"

#include <algorithm>
#include <nlohmann/json.hpp>
#include <stdexcept>

#include "elastimate/core/mesh/mesh.h"
#include "elastimate/core/text/numbers.h"
#include "elastimate/io/points/node_table.h"
#include "elastimate/io/scene/json_scene.h"
#include "elastimate/io/text/input_error.h"

namespace elastimate {
namespace {

using Json = nlohmann::ordered_json;

std::string WhatOf(const MeshFile& mesh, const PhysicalGroup& group) {
  std::string what = Counted(group.nodes.size(), "node");
  if (group.facets.cols() > 0) {
    what += ", " + Counted(static_cast<std::size_t>(group.facets.cols()),
                           mesh.Dimension() == 3 ? "face" : "edge");
  }
  if (group.dimension == mesh.Dimension()) {
    what = "elements with " + what;
    if (mesh.are_regions_groups && group.number > 0) {
      what += ", region " + std::to_string(group.number);
    }
  }
  return what;
}

/// Returns the selection of this name.
Json Selection(const MeshFile& mesh, const std::string& wanted) {
  std::string list;
  for (const MeshName& name : NamesOf(mesh)) {
    if (AreSameNames(mesh, name.name, wanted)) {
      return {{name.key, name.name}};
    }
    list += (list.empty() ? "" : ", ") + Printable(name.name);
  }
  ThrowInputError(mesh.path,
                  "it has nothing of the name '" + Printable(wanted) +
                      "'; its names are: " + (list.empty() ? "none" : list));
}

std::string RelativeTo(const std::filesystem::path& scene,
                       const std::filesystem::path& file) {
  const std::filesystem::path folder =
      std::filesystem::absolute(scene).parent_path();
  return std::filesystem::absolute(file).lexically_proximate(folder).string();
}

/// Throws for all that is wrong in a scene.json.
void CheckScene(const std::filesystem::path& path, const Json& document) {
  const nlohmann::json contents = document;
  ReadJsonScene(JsonValue(path, contents), Measurement::kOptional, {});
}

/// Tells whether the file has displacements of numbered nodes.
bool IsNodeTable(const std::filesystem::path& path, int dimension) {
  try {
    ReadNodeTable(path, dimension);
    return true;
  } catch (const std::invalid_argument&) {
    return false;
  }
}

}  // namespace

std::vector<MeshName> NamesOf(const MeshFile& mesh) {
  std::vector<MeshName> names;
  for (const PhysicalGroup& group : mesh.groups) {
    names.push_back(
        {mesh.sets_of.empty() ? "physical" : "set",
         group.name.empty() ? std::to_string(group.number) : group.name,
         WhatOf(mesh, group)});
  }
  for (const FileArray& array : mesh.node_arrays) {
    if (array.values.rows() == 1) {
      names.push_back({"array", array.name,
                       Counted(static_cast<std::size_t>(
                                   (array.values.array() != 0).count()),
                               "node") +
                           " where it is not zero"});
    }
  }
  return names;
}

std::string FirstSceneText(const std::filesystem::path& path,
                           const MeshFile& mesh, const FirstScene& scene) {
  if (!scene.loaded.empty() && scene.force.size() != mesh.Dimension()) {
    ThrowInputError(mesh.path, "a force on a mesh of " + mesh.Shapes() +
                                   " has " + std::to_string(mesh.Dimension()) +
                                   " components, but " +
                                   std::to_string(scene.force.size()) +
                                   " are given; correct it");
  }
  Json document = {{"mesh", RelativeTo(path, mesh.path)}};
  if (scene.section.model) {
    document["model"] = std::string(SectionModelName(*scene.section.model));
  }
  if (scene.section.thickness) {
    document["thickness"] = *scene.section.thickness;
  }
  document["supports"] = Json::array();
  for (const std::string& support : scene.supports) {
    document["supports"].push_back({{"nodes", Selection(mesh, support)}});
  }
  Json load_case = Json::object();
  if (!scene.points.empty()) {
    load_case["displacement"] = {{"points", RelativeTo(path, scene.points)}};
  }
  load_case["loads"] = Json::array();
  if (!scene.loaded.empty()) {
    load_case["loads"].push_back(
        {{"type", "force"},
         {"value", std::vector<double>(scene.force.begin(), scene.force.end())},
         {"surface", Selection(mesh, scene.loaded)}});
  }
  document["cases"] = Json::array({load_case});
  try {
    CheckScene(path, document);
  } catch (const std::invalid_argument&) {
    if (scene.points.empty() || !IsNodeTable(scene.points, mesh.Dimension())) {
      throw;
    }
    document["cases"][0]["displacement"] = {
        {"nodes", RelativeTo(path, scene.points)}};
    CheckScene(path, document);
  }
  return document.dump(2, ' ', false, Json::error_handler_t::replace) + "\n";
}

}  // namespace elastimate
