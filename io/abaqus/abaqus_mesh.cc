#include "elastimate/io/abaqus/abaqus_mesh.h"

#include <algorithm>
#include <boost/algorithm/string/case_conv.hpp>
#include <boost/algorithm/string/predicate.hpp>
#include <cmath>
#include <functional>
#include <map>
#include <optional>
#include <set>
#include <string>
#include <tuple>
#include <unordered_map>
#include <utility>
#include <vector>

#include "elastimate/io/abaqus/abaqus_deck.h"
#include "elastimate/io/abaqus/abaqus_elements.h"
#include "elastimate/io/abaqus/keyword_file.h"
#include "elastimate/io/mesh/section_number.h"
#include "elastimate/io/text/input_error.h"

namespace elastimate {
namespace {

using Members = NumberedSet::Members;

bool HasBody(const AbaqusScope& scope) {
  const std::vector<NumberedElement>& elements = scope.mesh.elements;
  return std::any_of(
      elements.begin(), elements.end(), [&](const NumberedElement& element) {
        const NumberedType& type = scope.mesh.types[element.type];
        return type.kind || type.dimension == 3;
      });
}

/// The body of a deck, whose numbers sets are about.
struct Body {
  const AbaqusScope* scope;
  const AbaqusInstance* instance = nullptr;  ///< Null for a flat file.
};

/// Returns the body of the deck, of which there has to be one.
Body FindBody(const std::filesystem::path& path, const AbaqusDeck& deck) {
  std::vector<Body> bodies;
  for (const AbaqusInstance& instance : deck.instances) {
    const auto part = deck.parts.find(boost::to_lower_copy(instance.part));
    if (part == deck.parts.end()) {
      instance.block->Fail("the part \"" + Printable(instance.part) +
                           "\" is not in the file; correct its name");
    }
    if (HasBody(part->second)) {
      bodies.push_back({&part->second, &instance});
    }
  }
  if (deck.instances.empty() && !deck.parts.empty()) {
    ThrowInputError(path,
                    "it has parts, but no *ASSEMBLY of instances; write the "
                    "file again");
  }
  if (HasBody(deck.outside) || bodies.empty()) {
    bodies.push_back({&deck.outside});
  }
  if (bodies.size() > 1) {
    ThrowInputError(
        path, "it has " + std::to_string(bodies.size()) +
                  " bodies (instances of parts with elements), but a scene is "
                  "of one; leave out all but the specimen, or merge them in "
                  "Abaqus/CAE (Instance > Merge/Cut)");
  }
  return bodies[0];
}

/// Finds the members of the sets of a deck.
class Sets {
 public:
  Sets(const AbaqusDeck& deck, const Body& body) : deck_(deck), body_(body) {
    const NumberedMesh& mesh = body.scope->mesh;
    std::vector<std::size_t> numbers = mesh.node_numbers;
    std::sort(numbers.begin(), numbers.end());
    nodes_ = std::move(numbers);
    for (std::size_t i = 0; i < mesh.elements.size(); ++i) {
      elements_.push_back(mesh.elements[i].number);
      element_places_.emplace(mesh.elements[i].number, i);
    }
    std::sort(elements_.begin(), elements_.end());
    AddNames(deck.outside.sets, false);
    if (body.scope != &deck.outside) {
      AddNames(body.scope->sets, true);
    }
  }

  /// Returns all sets that have names for people.
  std::vector<NumberedSet> All() {
    std::vector<NumberedSet> all;
    for (const auto& [key, definitions] : definitions_) {
      if (std::all_of(definitions.begin(), definitions.end(),
                      [](const AbaqusSet* set) { return set->is_internal; })) {
        continue;
      }
      NumberedSet set;
      set.name = NameOf(key, *definitions.front());
      set.members = key.members;
      Collect(key, set);
      all.push_back(std::move(set));
    }
    return all;
  }

  /// Returns the sets of the sections as they are called in All().
  std::vector<std::string> MaterialSets() const {
    std::vector<std::string> names;
    for (const std::string& name : body_.scope->mesh.material_sets) {
      const Key key = {Members::kElements, body_.scope != &deck_.outside,
                       boost::to_lower_copy(name)};
      const auto found = definitions_.find(key);
      if (found != definitions_.end()) {
        names.push_back(NameOf(key, *found->second.front()));
      }
    }
    return names;
  }

 private:
  struct Key {
    Members members;
    bool is_of_part;
    std::string name;  ///< In small letters.

    bool operator<(const Key& other) const {
      return std::tie(members, is_of_part, name) <
             std::tie(other.members, other.is_of_part, other.name);
    }
  };

  void AddNames(const std::vector<AbaqusSet>& sets, bool is_of_part) {
    for (const AbaqusSet& set : sets) {
      definitions_[{set.members, is_of_part, boost::to_lower_copy(set.name)}]
          .push_back(&set);
    }
  }

  std::string NameOf(const Key& key, const AbaqusSet& set) const {
    const bool is_in_both =
        key.is_of_part && body_.instance != nullptr &&
        std::any_of(
            definitions_.begin(), definitions_.end(), [&](const auto& other) {
              return !other.first.is_of_part && other.first.name == key.name;
            });
    return is_in_both ? body_.instance->name + "." + set.name : set.name;
  }

  /// Tells whether numbers and names of the set are those of the body.
  bool IsOfBody(const AbaqusSet& set, bool is_of_part) const {
    return is_of_part || body_.scope == &deck_.outside ||
           (body_.instance != nullptr &&
            boost::iequals(set.instance, body_.instance->name));
  }

  void Collect(const Key& key, NumberedSet& to) {
    if (!open_.insert(key).second) {
      return;  // A set that adds to itself.
    }
    for (const AbaqusSet* set : definitions_.at(key)) {
      for (const AbaqusEntry& entry : set->entries) {
        CollectEntry(*set, key.is_of_part, entry, to);
      }
    }
    open_.erase(key);
  }

  void CollectEntry(const AbaqusSet& set, bool is_of_part, AbaqusEntry entry,
                    NumberedSet& to) {
    bool is_of_body = IsOfBody(set, is_of_part);
    if (const std::size_t dot = entry.name.find('.');
        dot != std::string::npos && body_.instance != nullptr) {
      is_of_body =
          boost::iequals(entry.name.substr(0, dot), body_.instance->name);
      if (!is_of_body) {
        return;  // It is about another instance.
      }
      entry.name.erase(0, dot + 1);
      if (entry.name.find_first_not_of("0123456789") == std::string::npos &&
          entry.name.size() < 19 && !entry.name.empty()) {
        entry.first = entry.last = std::stoull(entry.name);
        entry.name.clear();
      }
    }
    if (!entry.name.empty()) {
      CollectNamed(set, is_of_body, entry, to);
    } else if (is_of_body) {
      CollectNumbers(set, entry, to);
    }
  }

  void CollectNumbers(const AbaqusSet& set, const AbaqusEntry& entry,
                      NumberedSet& to) {
    if (set.members == Members::kFacets) {
      AddFaces(set, entry, {entry.first}, to);
      return;
    }
    const bool are_nodes = set.members == Members::kNodes;
    const std::vector<std::size_t>& all = are_nodes ? nodes_ : elements_;
    const std::size_t before = to.numbers.size();
    for (auto number = std::lower_bound(all.begin(), all.end(), entry.first);
         number != all.end() && *number <= entry.last; ++number) {
      if ((*number - entry.first) % entry.step == 0) {
        to.numbers.push_back(*number);
      }
    }
    if (to.numbers.size() == before && entry.first == entry.last) {
      set.block->FailAt(entry.line,
                        "the set \"" + Printable(set.name) + "\" names " +
                            (are_nodes ? "node " : "element ") +
                            std::to_string(entry.first) +
                            ", which the file does not have; correct it");
    }
  }

  void CollectNamed(const AbaqusSet& set, bool is_of_part,
                    const AbaqusEntry& entry, NumberedSet& to) {
    const bool are_elements =
        set.members == Members::kFacets || entry.is_nodes_of_elements;
    const Key key = {are_elements ? Members::kElements : set.members,
                     is_of_part && body_.scope != &deck_.outside,
                     boost::to_lower_copy(entry.name)};
    if (definitions_.count(key) == 0) {
      set.block->FailAt(entry.line,
                        "the set \"" + Printable(set.name) + "\" names \"" +
                            Printable(entry.name) +
                            "\", which is no set of the file; correct it");
    }
    if (!are_elements) {
      Collect(key, to);
      return;
    }
    NumberedSet elements;
    Collect(key, elements);
    if (set.members == Members::kFacets) {
      AddFaces(set, entry, elements.numbers, to);
    } else {
      AddNodesOf(elements.numbers, to);
    }
  }

  void AddNodesOf(const std::vector<std::size_t>& elements, NumberedSet& to) {
    const NumberedMesh& mesh = body_.scope->mesh;
    for (const std::size_t number : elements) {
      const NumberedElement& element =
          mesh.elements[element_places_.at(number)];
      const auto first = mesh.nodes_of_elements.begin() +
                         static_cast<std::ptrdiff_t>(element.first_node);
      to.numbers.insert(to.numbers.end(), first,
                        first + static_cast<std::ptrdiff_t>(element.num_nodes));
    }
  }

  void AddFaces(const AbaqusSet& set, const AbaqusEntry& entry,
                const std::vector<std::size_t>& elements, NumberedSet& to) {
    const NumberedMesh& mesh = body_.scope->mesh;
    for (const std::size_t number : elements) {
      const auto place = element_places_.find(number);
      if (place == element_places_.end()) {
        set.block->FailAt(entry.line, "the surface \"" + Printable(set.name) +
                                          "\" names element " +
                                          std::to_string(number) +
                                          ", which the file does not have; "
                                          "correct it");
      }
      const NumberedType& type = mesh.types[mesh.elements[place->second].type];
      NumberedFace face = {number, {}};
      if (!entry.face.empty() && entry.face != "SPOS" && entry.face != "SNEG" &&
          (type.kind || type.Cell() != nullptr)) {
        face.vertices = AbaqusFace(type, entry.face);
        if (face.vertices.empty()) {
          set.block->FailAt(entry.line, "'" + Printable(entry.face) +
                                            "' is no face of an element of "
                                            "type " +
                                            Printable(type.name) +
                                            "; correct it");
        }
      }
      to.faces.push_back(std::move(face));
    }
  }

  const AbaqusDeck& deck_;
  const Body body_;
  std::vector<std::size_t> nodes_;     ///< Ascending.
  std::vector<std::size_t> elements_;  ///< Ascending.
  std::unordered_map<std::size_t, std::size_t> element_places_;
  std::map<Key, std::vector<const AbaqusSet*>> definitions_;
  std::set<Key> open_;
};

/// Notes which types of elements are read in another way than Abaqus takes
/// them.
void NoteTypes(const NumberedMesh& numbered, MeshFile& mesh) {
  std::set<std::string> changed;
  for (const NumberedType& type : numbered.types) {
    const std::string full = FullAbaqusType(type.name);
    if (type.dimension == mesh.Dimension() && full != type.name) {
      changed.insert(type.name + " are read as " + full);
    }
  }
  for (const std::string& change : changed) {
    mesh.notices.push_back(
        "its elements of type " + Printable(change) +
        ", because reduced integration, incompatible modes and the like belong "
        "to the solver of Abaqus, not to the mesh");
  }
}

/// Planar elements say what model they are for.
void SetSection(const NumberedMesh& numbered, double thickness,
                MeshFile& mesh) {
  if (mesh.Dimension() != 2 || mesh.elements.cols() == 0) {
    return;
  }
  const bool has_stress = std::any_of(
      numbered.types.begin(), numbered.types.end(), [](const NumberedType& t) {
        return t.NumNodes() > 0 && t.name.rfind("CPS", 0) == 0;
      });
  const bool has_strain = std::any_of(
      numbered.types.begin(), numbered.types.end(), [](const NumberedType& t) {
        return t.NumNodes() > 0 && t.name.rfind("CPE", 0) == 0;
      });
  if (has_stress != has_strain) {
    const auto* const place = std::find(
        kNumberedModels.begin(), kNumberedModels.end(),
        has_stress ? SectionModel::kPlaneStress : SectionModel::kPlaneStrain);
    mesh.model = double(place - kNumberedModels.begin());
  } else if (has_stress) {
    mesh.why_no_model =
        "some of its elements are in plane stress (CPS) and others in plane "
        "strain (CPE), but a scene has one model";
  }
  if (thickness > 0) {
    mesh.thickness = thickness;
  }
}

}  // namespace

MeshFile ReadAbaqusMesh(const std::filesystem::path& path) {
  const KeywordFile file = ReadKeywordFile(path);
  const AbaqusDeck deck = ParseAbaqusDeck(file);
  const Body body = FindBody(path, deck);
  NumberedMesh numbered = body.scope->mesh;
  numbered.program = "Abaqus";
  Sets sets(deck, body);
  numbered.sets = sets.All();
  numbered.material_sets = sets.MaterialSets();
  if (body.instance != nullptr) {
    for (Eigen::Vector3d& position : numbered.positions) {
      position = body.instance->placement * position;
    }
  }
  MeshFile mesh = ToMeshFile(path, numbered);
  NoteTypes(numbered, mesh);
  if (deck.has_ties) {
    mesh.notices.push_back(
        "*TIE is not read, so that it does not connect what it joins; give "
        "these parts the same nodes in the mesh tool if they are one specimen");
  }
  SetSection(numbered, deck.thickness, mesh);
  return mesh;
}

}  // namespace elastimate
