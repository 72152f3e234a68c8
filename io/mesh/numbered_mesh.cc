#include "elastimate/io/mesh/numbered_mesh.h"

#include <algorithm>
#include <limits>
#include <map>
#include <utility>

#include "elastimate/core/text/numbers.h"
#include "elastimate/io/mesh/numbering.h"
#include "elastimate/io/text/input_error.h"

namespace elastimate {
namespace {

using Members = NumberedSet::Members;
using Vertices = std::array<int, 4>;

/// The vertices, ascending; -1 where there are fewer than four.
template <typename Nodes>
Vertices Sorted(const Nodes& nodes) {
  Vertices sorted = {-1, -1, -1, -1};
  std::copy_n(nodes.begin(), std::min<std::size_t>(nodes.size(), 4),
              sorted.begin());
  std::sort(sorted.begin(), sorted.end());
  return sorted;
}

/// A face of an element of the mesh.
struct OwnedFace {
  Vertices vertices;
  int element;
  int face;

  bool operator<(const OwnedFace& other) const {
    return vertices < other.vertices;
  }
};

/// Makes a MeshFile, in the order of the functions below.
class Conversion {
 public:
  Conversion(const std::filesystem::path& path, const NumberedMesh& from)
      : from_(from) {
    mesh_.path = path;
    mesh_.is_vtk = false;
    mesh_.sets_of = from.program;
  }

  void CopyNodes() {
    if (from_.node_numbers.size() >
        std::size_t(std::numeric_limits<int>::max())) {
      ThrowInputError(mesh_.path,
                      "the mesh has more than 2^31 nodes; coarsen it");
    }
    mesh_.nodes.resize(3, static_cast<Eigen::Index>(from_.positions.size()));
    Eigen::Index column = 0;
    for (const std::size_t i : SortingOrder(from_.node_numbers)) {
      mesh_.nodes.col(column++) = from_.positions[i];
      mesh_.node_numbers.push_back(from_.node_numbers[i]);
    }
    CheckDiffer("node", mesh_.node_numbers);
    nodes_ = Numbering(mesh_.node_numbers);
  }

  void ChooseElements() {
    for (const NumberedElement& element : from_.elements) {
      dimension_ = std::max(dimension_, TypeOf(element).dimension);
    }
    const NumberedElement* first = nullptr;
    for (const NumberedElement& element : from_.elements) {
      const NumberedType& type = TypeOf(element);
      if (type.dimension != dimension_ || dimension_ < 2) {
        continue;
      }
      const std::string is_of = "element " + std::to_string(element.number) +
                                " is of type " + Printable(type.name);
      if (!type.kind) {
        ThrowInputError(mesh_.path, is_of + ", " + type.mend);
      }
      if (first != nullptr && type.kind != TypeOf(*first).kind) {
        ThrowInputError(mesh_.path,
                        is_of + ", but others are of type " +
                            Printable(TypeOf(*first).name) +
                            "; mesh the specimen with one kind of element");
      }
      first = first == nullptr ? &element : first;
      chosen_.push_back(&element);
    }
    if (first != nullptr) {
      mesh_.kind = *TypeOf(*first).kind;
    }
    mesh_.has_other_cells = chosen_.size() != from_.elements.size();
  }

  void CopyElements() {
    std::vector<std::size_t> numbers;
    for (const NumberedElement* element : chosen_) {
      numbers.push_back(element->number);
    }
    const std::vector<std::size_t> order = SortingOrder(numbers);
    std::sort(numbers.begin(), numbers.end());
    CheckDiffer("element", numbers);
    const std::size_t num_nodes = mesh_.Topology().num_nodes;
    mesh_.elements.resize(static_cast<Eigen::Index>(num_nodes),
                          static_cast<Eigen::Index>(order.size()));
    for (std::size_t k = 0; k < order.size(); ++k) {
      const std::vector<int> nodes = NodesOf(*chosen_[order[k]], num_nodes);
      std::copy(nodes.begin(), nodes.end(),
                mesh_.elements.col(static_cast<Eigen::Index>(k)).begin());
    }
    elements_ = Numbering(std::move(numbers));
  }

  void IndexOtherElements() {
    std::vector<std::pair<std::size_t, const NumberedElement*>> all;
    for (const NumberedElement& element : from_.elements) {
      if (TypeOf(element).dimension != mesh_.Dimension()) {
        all.emplace_back(element.number, &element);
      }
    }
    std::sort(all.begin(), all.end());
    std::vector<std::size_t> numbers;
    for (const auto& [number, element] : all) {
      numbers.push_back(number);
      others_.push_back(element);
    }
    CheckDiffer("element", numbers);
    for (const std::size_t number : numbers) {
      if (elements_.Find(number) >= 0) {
        ThrowTwice("element", number);
      }
    }
    other_numbers_ = Numbering(std::move(numbers));
  }

  void CopySets() {
    for (const NumberedSet& set : from_.sets) {
      PhysicalGroup group;
      group.name = set.name;
      group.number = 0;
      group.dimension = set.members == Members::kNodes ? 0
                        : set.members == Members::kFacets
                            ? mesh_.Dimension() - 1
                            : DimensionOfElements(set);
      AddMembers(set, group);
      std::sort(group.nodes.begin(), group.nodes.end());
      group.nodes.erase(std::unique(group.nodes.begin(), group.nodes.end()),
                        group.nodes.end());
      mesh_.groups.push_back(std::move(group));
    }
  }

  void MakeRegions() {
    std::vector<std::size_t> sets = RegionSets();
    Eigen::MatrixXd regions = Eigen::MatrixXd::Zero(1, mesh_.elements.cols());
    int number = 0;
    for (const std::size_t i : sets) {
      mesh_.groups[i].number = ++number;
      for (const std::size_t element : from_.sets[i].numbers) {
        const int place = elements_.Find(element);
        if (place < 0) {
          continue;
        }
        double& region = regions(place);
        if (region != 0 && region != number && mesh_.why_no_regions.empty()) {
          mesh_.why_no_regions =
              mesh_.Shape() + " " + std::to_string(place) +
              " is in the sets \"" +
              Printable(mesh_.groups[sets[static_cast<std::size_t>(region) - 1]]
                            .name) +
              "\" and \"" + Printable(mesh_.groups[i].name) + "\"";
        }
        region = number;
      }
    }
    mesh_.are_regions_groups = number > 0 && mesh_.why_no_regions.empty();
    if (mesh_.are_regions_groups) {
      mesh_.element_arrays.push_back({"region", regions});
    }
  }

  /// Shells, bars and the like may be a part of what was computed.
  void NoteOthers() {
    std::map<std::string, std::size_t> counts;
    for (const NumberedElement* element : others_) {
      ++counts[TypeOf(*element).name];
    }
    for (const auto& [name, count] : counts) {
      const bool is_one = count == 1;
      mesh_.notices.push_back(Counted(count, "element") + " of type " +
                              Printable(name) + (is_one ? " is" : " are") +
                              " left out, except for " +
                              (is_one ? "its" : "their") + " sets");
    }
  }

  MeshFile Take() { return std::move(mesh_); }

 private:
  const NumberedType& TypeOf(const NumberedElement& element) const {
    return from_.types[element.type];
  }

  [[noreturn]] void ThrowTwice(const std::string& what,
                               std::size_t number) const {
    ThrowInputError(mesh_.path,
                    "it has the " + what + " number " + std::to_string(number) +
                        " twice; give each " + what + " its own number");
  }

  void CheckDiffer(const std::string& what,
                   const std::vector<std::size_t>& sorted) const {
    const auto twin = std::adjacent_find(sorted.begin(), sorted.end());
    if (twin != sorted.end()) {
      ThrowTwice(what, *twin);
    }
  }

  int PlaceOfNode(std::size_t number, const std::string& of) const {
    const int node = nodes_.Find(number);
    if (node < 0) {
      ThrowInputError(mesh_.path, of + " names node " + std::to_string(number) +
                                      ", which the file does not have; correct "
                                      "it, or write the file again");
    }
    return node;
  }

  /// Returns the first nodes of an element.
  std::vector<int> NodesOf(const NumberedElement& element,
                           std::size_t count) const {
    std::vector<int> nodes;
    for (std::size_t i = 0; i < std::min(count, element.num_nodes); ++i) {
      nodes.push_back(
          PlaceOfNode(from_.nodes_of_elements[element.first_node + i],
                      "element " + std::to_string(element.number)));
    }
    return nodes;
  }

  /// Elements of a lower dimension are in the set by their dimension.
  int DimensionOfElements(const NumberedSet& set) const {
    int dimension = 0;
    for (const std::size_t number : set.numbers) {
      const int other = other_numbers_.Find(number);
      dimension =
          std::max(dimension, other < 0 ? mesh_.Dimension()
                                        : TypeOf(*others_[other]).dimension);
    }
    return dimension;
  }

  void AddMembers(const NumberedSet& set, PhysicalGroup& group) {
    const std::string of = "the set \"" + Printable(set.name) + "\"";
    std::vector<std::vector<int>> facets;
    for (const std::size_t number : set.numbers) {
      if (set.members == Members::kNodes) {
        group.nodes.push_back(PlaceOfNode(number, of));
      } else {
        AddElement(number, of, group, facets);
      }
    }
    for (const NumberedFace& face : set.faces) {
      AddFace(face, of, facets);
    }
    for (const std::vector<std::size_t>& numbers : set.facets) {
      std::vector<int> facet;
      facet.reserve(numbers.size());
      for (const std::size_t number : numbers) {
        facet.push_back(PlaceOfNode(number, of));
      }
      if (int(facet.size()) == mesh_.Topology().NumVerticesOfFace()) {
        facets.push_back(std::move(facet));
      }
    }
    AddFacets(facets, group);
  }

  void AddElement(std::size_t number, const std::string& of,
                  PhysicalGroup& group,
                  std::vector<std::vector<int>>& facets) const {
    if (const int place = elements_.Find(number); place >= 0) {
      const auto nodes = mesh_.elements.col(place);
      group.nodes.insert(group.nodes.end(), nodes.begin(), nodes.end());
      return;
    }
    const NumberedElement& element = Other(number, of);
    const std::vector<int> nodes = NodesOf(element, element.num_nodes);
    group.nodes.insert(group.nodes.end(), nodes.begin(), nodes.end());
    if (IsFacet(element)) {
      facets.push_back(VerticesOf(element));
    }
  }

  const NumberedElement& Other(std::size_t number,
                               const std::string& of) const {
    const int other = other_numbers_.Find(number);
    if (other < 0) {
      ThrowInputError(mesh_.path, of + " names element " +
                                      std::to_string(number) +
                                      ", which the file does not have; correct "
                                      "it, or write the file again");
    }
    return *others_[other];
  }

  bool IsFacet(const NumberedElement& element) const {
    const NumberedType& type = TypeOf(element);
    return type.dimension == mesh_.Dimension() - 1 &&
           type.num_vertices == mesh_.Topology().NumVerticesOfFace();
  }

  std::vector<int> VerticesOf(const NumberedElement& element) const {
    return NodesOf(element, TypeOf(element).num_vertices);
  }

  void AddFace(const NumberedFace& face, const std::string& of,
               std::vector<std::vector<int>>& facets) {
    const int place = elements_.Find(face.element);
    if (place < 0) {
      const NumberedElement& element = Other(face.element, of);
      if (IsFacet(element)) {
        facets.push_back(VerticesOf(element));
      }
      return;
    }
    if (!face.vertices.empty()) {
      const Eigen::VectorXi nodes = mesh_.elements(face.vertices, place);
      facets.emplace_back(nodes.begin(), nodes.end());
      return;
    }
    for (const std::vector<int>& vertices : mesh_.Topology().faces) {
      const Eigen::VectorXi nodes = mesh_.elements(vertices, place);
      const auto [first, last] = std::equal_range(
          Faces().begin(), Faces().end(), OwnedFace{Sorted(nodes), 0, 0});
      if (last - first == 1) {
        facets.emplace_back(nodes.begin(), nodes.end());
      }
    }
  }

  /// The faces of all elements, those of two elements twice.
  const std::vector<OwnedFace>& Faces() {
    if (faces_.empty()) {
      const ElementTopology& topology = mesh_.Topology();
      for (Eigen::Index i = 0; i < mesh_.elements.cols(); ++i) {
        for (std::size_t k = 0; k < topology.faces.size(); ++k) {
          const Eigen::VectorXi nodes = mesh_.elements(topology.faces[k], i);
          faces_.push_back(
              {Sorted(nodes), static_cast<int>(i), static_cast<int>(k)});
        }
      }
      std::sort(faces_.begin(), faces_.end());
    }
    return faces_;
  }

  /// Appends facets, and all nodes of the faces that have their vertices.
  void AddFacets(const std::vector<std::vector<int>>& facets,
                 PhysicalGroup& group) {
    const int num_vertices = mesh_.Topology().NumVerticesOfFace();
    group.facets.resize(facets.empty() ? 0 : num_vertices,
                        static_cast<Eigen::Index>(facets.size()));
    for (std::size_t i = 0; i < facets.size(); ++i) {
      std::copy(facets[i].begin(), facets[i].end(),
                group.facets.col(static_cast<Eigen::Index>(i)).begin());
      const OwnedFace wanted = {Sorted(facets[i]), 0, 0};
      const auto found =
          std::lower_bound(Faces().begin(), Faces().end(), wanted);
      const bool is_face =
          found != Faces().end() && found->vertices == wanted.vertices;
      const std::vector<int> nodes = is_face ? NodesOfFace(*found) : facets[i];
      group.nodes.insert(group.nodes.end(), nodes.begin(), nodes.end());
    }
  }

  std::vector<int> NodesOfFace(const OwnedFace& owned) const {
    const ElementTopology& topology = mesh_.Topology();
    const std::vector<int>& face = topology.faces[owned.face];
    std::vector<int> places = face;
    for (std::size_t i = 0;
         topology.order == 2 && i < topology.middles_of_face.size(); ++i) {
      std::vector<int> vertices;
      for (const int vertex : topology.middles_of_face[i]) {
        vertices.push_back(face[vertex]);
      }
      places.push_back(topology.MiddleNode(vertices));
    }
    const Eigen::VectorXi nodes = mesh_.elements(places, owned.element);
    return {nodes.begin(), nodes.end()};
  }

  /// The sets that become regions.
  std::vector<std::size_t> RegionSets() const {
    std::vector<std::size_t> with_material;
    std::vector<std::size_t> of_all;
    std::vector<std::size_t> others;
    for (std::size_t i = 0; i < from_.sets.size(); ++i) {
      const NumberedSet& set = from_.sets[i];
      if (set.members != Members::kElements ||
          mesh_.groups[i].dimension != mesh_.Dimension()) {
        continue;
      }
      const auto& names = from_.material_sets;
      if (std::find(names.begin(), names.end(), set.name) != names.end()) {
        with_material.push_back(i);
      }
      (HasAllElements(set) ? of_all : others).push_back(i);
    }
    return !with_material.empty() ? with_material
           : !others.empty()      ? others
                                  : of_all;
  }

  bool HasAllElements(const NumberedSet& set) const {
    std::vector<char> is_member(mesh_.elements.cols(), 0);
    for (const std::size_t number : set.numbers) {
      if (const int place = elements_.Find(number); place >= 0) {
        is_member[place] = 1;
      }
    }
    return std::find(is_member.begin(), is_member.end(), 0) == is_member.end();
  }

  const NumberedMesh& from_;
  MeshFile mesh_;
  int dimension_ = 0;
  std::vector<const NumberedElement*> chosen_;
  std::vector<const NumberedElement*> others_;  ///< By ascending numbers.
  Numbering nodes_{{}};
  Numbering elements_{{}};
  Numbering other_numbers_{{}};
  std::vector<OwnedFace> faces_;
};

}  // namespace

MeshFile ToMeshFile(const std::filesystem::path& path,
                    const NumberedMesh& numbered) {
  Conversion conversion(path, numbered);
  conversion.CopyNodes();
  conversion.ChooseElements();
  conversion.CopyElements();
  conversion.IndexOtherElements();
  conversion.CopySets();
  conversion.MakeRegions();
  conversion.NoteOthers();
  return conversion.Take();
}

}  // namespace elastimate
