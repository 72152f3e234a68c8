#include "elastimate/io/febio/febio_mesh.h"

#include <algorithm>
#include <map>
#include <new>
#include <optional>
#include <pugixml.hpp>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "elastimate/core/text/numbers.h"
#include "elastimate/io/mesh/numbered_mesh.h"
#include "elastimate/io/text/input_error.h"
#include "elastimate/io/text/parsed_number.h"

namespace elastimate {
namespace {

using Members = NumberedSet::Members;

NumberedType FebioType(const std::string& name) {
  // Each type that is not for scenes has the dimension and the number of
  // vertices of its facet.
  static const std::map<std::string, NumberedType> kTypes = {
      {"tet4", {"", 3, ElementKind::kTet4, 4, "", false}},
      {"tet10", {"", 3, ElementKind::kTet10, 4, "", false}},
      {"hex8", {"", 3, ElementKind::kHex8, 8, "", false}},
      {"hex20", {"", 3, {}, 8, "", true}},
      {"penta6", {"", 3, {}, 6, "", false}},
      {"penta15", {"", 3, {}, 6, "", true}},
      {"pyra5", {"", 3, {}, 5, "", false}},
      {"pyra13", {"", 3, {}, 5, "", true}},
      {"line2", {"", 1, {}, 2, "", false}},
      {"line3", {"", 1, {}, 2, "", false}},
      {"truss2", {"", 1, {}, 2, "", false}},
      {"tri3", {"", 2, {}, 3, "", false}},
      {"tri6", {"", 2, {}, 3, "", false}},
      {"tri7", {"", 2, {}, 3, "", false}},
      {"quad4", {"", 2, {}, 4, "", false}},
      {"q4ans", {"", 2, {}, 4, "", false}},
      {"q4eas", {"", 2, {}, 4, "", false}},
      {"quad8", {"", 2, {}, 4, "", false}},
      {"quad9", {"", 2, {}, 4, "", false}}};
  const auto found = kTypes.find(name);
  NumberedType type = found == kTypes.end()
                          ? NumberedType{"", 3, {}, 0, "", false}
                          : found->second;
  type.name = name;
  if (type.dimension < 3) {
    type.mend = "but a scene needs solid elements; mesh the volume";
  } else if (found == kTypes.end()) {
    type.mend =
        "but the solid elements of FEBio that are read are tet4, tet10, hex8, "
        "hex20, penta6, penta15, pyra5 and pyra13; mesh the specimen with "
        "these (FEBio Studio: Mesh > Convert)";
  }
  return type;
}

/// Reads the parts of a file one after the other.
class FebioReader {
 public:
  explicit FebioReader(const std::filesystem::path& path) : path_(path) {
    mesh_.program = "FEBio";
  }

  NumberedMesh Read(const pugi::xml_node& root) {
    const pugi::xml_node mesh = root.child("Mesh");
    if (mesh.attribute("from")) {
      ThrowInputError(path_, "its mesh is in another file (\"" +
                                 Printable(mesh.attribute("from").value()) +
                                 "\"); give that file");
    }
    for (const pugi::xml_node& part : mesh.children()) {
      const std::string_view name = part.name();
      if (name == "Nodes") {
        ReadNodes(part);
      } else if (name == "Elements") {
        ReadElements(part);
      } else if (name == "NodeSet") {
        AddSet(part, Members::kNodes).numbers = Numbers(part);
      } else if (name == "ElementSet") {
        AddSet(part, Members::kElements).numbers = Numbers(part);
      } else if (name == "Surface") {
        ReadSurface(part);
      }
    }
    return std::move(mesh_);
  }

 private:
  /// "Surface \"top\"".
  static std::string NameOf(const pugi::xml_node& part) {
    return std::string(part.name()) + " \"" +
           Printable(part.attribute("name").value()) + "\"";
  }

  [[noreturn]] void Fail(const pugi::xml_node& part,
                         const std::string& sentence) const {
    ThrowInputError(path_, NameOf(part) + " " + sentence + "; correct it");
  }

  /// Reads the numbers of a text, which are separated by commas and blanks.
  template <typename Number>
  std::vector<Number> ListIn(const pugi::xml_node& part,
                             std::string_view text) const {
    constexpr char kSeparators[] = ", \t\r\n";
    std::vector<Number> numbers;
    for (std::size_t first = text.find_first_not_of(kSeparators);
         first != std::string_view::npos;
         first = text.find_first_not_of(kSeparators, first)) {
      const std::size_t end =
          std::min(text.find_first_of(kSeparators, first), text.size());
      const std::string_view word = text.substr(first, end - first);
      const std::optional<Number> number = ParsedNumber<Number>(word);
      if (!number) {
        Fail(part, "has '" + Printable(word) + "' where a number is due");
      }
      numbers.push_back(*number);
      first = end;
    }
    return numbers;
  }

  std::size_t IdOf(const pugi::xml_node& part,
                   const pugi::xml_node& item) const {
    const std::vector<std::size_t> id =
        ListIn<std::size_t>(part, item.attribute("id").value());
    if (id.size() != 1) {
      Fail(part, "has an item without a number as its id");
    }
    return id[0];
  }

  void ReadNodes(const pugi::xml_node& part) {
    const bool is_named = !part.attribute("name").empty();
    NumberedSet set = {
        part.attribute("name").value(), Members::kNodes, {}, {}, {}};
    for (const pugi::xml_node& node : part.children("node")) {
      const std::vector<double> position =
          ListIn<double>(part, node.child_value());
      const std::size_t id = IdOf(part, node);
      if (position.size() != 3) {
        Fail(part, "has node " + std::to_string(id) + " with " +
                       Counted(position.size(), "coordinate") +
                       " where 3 are due");
      }
      mesh_.node_numbers.push_back(id);
      mesh_.positions.emplace_back(position[0], position[1], position[2]);
      set.numbers.push_back(id);
    }
    if (is_named) {
      mesh_.sets.push_back(std::move(set));
    }
  }

  void ReadElements(const pugi::xml_node& part) {
    const std::string name = part.attribute("type").value();
    const std::size_t type = mesh_.types.size();
    mesh_.types.push_back(FebioType(name));
    const NumberedType& of_part = mesh_.types.back();
    NumberedSet set = {
        part.attribute("name").value(), Members::kElements, {}, {}, {}};
    for (const pugi::xml_node& element : part.children("elem")) {
      const std::vector<std::size_t> nodes =
          ListIn<std::size_t>(part, element.child_value());
      const std::size_t id = IdOf(part, element);
      const auto due = static_cast<std::size_t>(of_part.NumNodes());
      if (due > 0 && nodes.size() != due) {
        Fail(part, "has element " + std::to_string(id) + " of type " + name +
                       " with " + Counted(nodes.size(), "node") + " where " +
                       std::to_string(due) + " are due");
      }
      mesh_.elements.push_back(
          {id, type, mesh_.nodes_of_elements.size(), nodes.size()});
      mesh_.nodes_of_elements.insert(mesh_.nodes_of_elements.end(),
                                     nodes.begin(), nodes.end());
      set.numbers.push_back(id);
    }
    if (!set.name.empty()) {
      mesh_.material_sets.push_back(set.name);
      mesh_.sets.push_back(std::move(set));
    }
  }

  NumberedSet& AddSet(const pugi::xml_node& part, Members members) {
    mesh_.sets.push_back({part.attribute("name").value(), members, {}, {}, {}});
    return mesh_.sets.back();
  }

  /// Returns the numbers in the text (version 4) or of items (version 3).
  std::vector<std::size_t> Numbers(const pugi::xml_node& part) const {
    std::vector<std::size_t> numbers;
    for (const pugi::xml_node& item : part.children()) {
      if (item.type() == pugi::node_element) {
        numbers.push_back(IdOf(part, item));
      } else if (item.type() == pugi::node_pcdata) {
        const std::vector<std::size_t> some =
            ListIn<std::size_t>(part, item.value());
        numbers.insert(numbers.end(), some.begin(), some.end());
      }
    }
    return numbers;
  }

  void ReadSurface(const pugi::xml_node& part) {
    NumberedSet& set = AddSet(part, Members::kFacets);
    for (const pugi::xml_node& facet : part.children()) {
      if (facet.type() != pugi::node_element) {
        continue;
      }
      const NumberedType type = FebioType(facet.name());
      std::vector<std::size_t> nodes =
          ListIn<std::size_t>(part, facet.child_value());
      if (type.dimension != 2 ||
          nodes.size() < static_cast<std::size_t>(type.num_vertices)) {
        Fail(part, "has a facet '" + Printable(facet.name()) + "' of " +
                       Counted(nodes.size(), "node") + ", which is none");
      }
      nodes.resize(type.num_vertices);
      set.facets.push_back(std::move(nodes));
    }
  }

  const std::filesystem::path path_;
  NumberedMesh mesh_;
};

}  // namespace

MeshFile ReadFebioMesh(const std::filesystem::path& path) {
  pugi::xml_document document;
  const pugi::xml_parse_result parsed = document.load_file(path.c_str());
  if (parsed.status == pugi::status_out_of_memory) {
    throw std::bad_alloc();
  }
  if (!parsed) {
    ThrowDamagedFile(path, std::string(parsed.description()) + " at byte " +
                               std::to_string(parsed.offset));
  }
  const pugi::xml_node root = document.child("febio_spec");
  const std::string version = root.attribute("version").value();
  if (version.empty()) {
    ThrowDamagedFile(path, "it has no <febio_spec version=...>");
  }
  if (version[0] != '3' && version[0] != '4') {
    ThrowInputError(path, "it is of FEBio's format " + Printable(version) +
                              ", but 3 and 4 are read; export it from FEBio "
                              "Studio as FEBio 4");
  }
  return ToMeshFile(path, FebioReader(path).Read(root));
}

}  // namespace elastimate
