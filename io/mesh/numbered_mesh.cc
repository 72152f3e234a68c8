#include "elastimate/io/mesh/numbered_mesh.h"

#include <algorithm>
#include <limits>
#include <map>
#include <utility>

#include "elastimate/core/text/numbers.h"
#include "elastimate/io/mesh/cut_cells.h"
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
    for (const NumberedElement& element : from_.elements) {
      if (TypeOf(element).dimension == dimension_ && dimension_ >= 2) {
        chosen_.push_back(&element);
      }
    }
    mesh_.has_other_cells = chosen_.size() != from_.elements.size();
    are_cut_ = AreToBeCut();
    if (!are_cut_ && !chosen_.empty()) {
      mesh_.kind = TheOneKind();
    }
  }

  void CopyElements() {
    std::vector<std::size_t> numbers;
    for (const NumberedElement* element : chosen_) {
      numbers.push_back(element->number);
    }
    const std::vector<std::size_t> order = SortingOrder(numbers);
    std::sort(numbers.begin(), numbers.end());
    CheckDiffer("element", numbers);
    elements_ = Numbering(std::move(numbers));
    for (const std::size_t k : order) {
      cells_.push_back(chosen_[k]);
    }
    if (are_cut_) {
      CutElements();
    } else {
      CopyWholeElements();
    }
    for (std::size_t k = 0; k < cells_.size(); ++k) {
      mesh_.element_numbers.insert(
          mesh_.element_numbers.end(),
          std::size_t(first_part_[k + 1] - first_part_[k]), cells_[k]->number);
    }
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
      if (set.members == Members::kNodes) {
        AddNodesBetween(mesh_, group.nodes);
      }
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
        auto parts = regions.middleCols(
            first_part_[place], first_part_[place + 1] - first_part_[place]);
        const double region = parts(0);
        if (region != 0 && region != number && mesh_.why_no_regions.empty()) {
          mesh_.why_no_regions =
              ElementName(mesh_, first_part_[place]) + " is in the sets \"" +
              Printable(mesh_.groups[sets[static_cast<std::size_t>(region) - 1]]
                            .name) +
              "\" and \"" + Printable(mesh_.groups[i].name) + "\"";
        }
        parts.setConstant(number);
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

  /// Tells whether all elements may be cut, and are not of one kind otherwise.
  bool AreToBeCut() const {
    const auto has_cell = [this](const NumberedElement* element) {
      return TypeOf(*element).Cell() != nullptr &&
             TypeOf(*element).Order() == TypeOf(*chosen_[0]).Order();
    };
    const auto is_another = [this](const NumberedElement* element) {
      return !TypeOf(*element).kind ||
             TypeOf(*element).kind != TypeOf(*chosen_[0]).kind;
    };
    return std::all_of(chosen_.begin(), chosen_.end(), has_cell) &&
           std::any_of(chosen_.begin(), chosen_.end(), is_another);
  }

  ElementKind TheOneKind() const {
    for (const NumberedElement* element : chosen_) {
      const NumberedType& type = TypeOf(*element);
      if (!type.kind && !type.mend.empty()) {
        ThrowInputError(mesh_.path, "element " +
                                        std::to_string(element->number) +
                                        " is of type " + Printable(type.name) +
                                        ", " + type.mend);
      }
    }
    const NumberedType& first = TypeOf(*chosen_[0]);
    for (const NumberedElement* element : chosen_) {
      const NumberedType& type = TypeOf(*element);
      const std::string is_of = "element " + std::to_string(element->number) +
                                " is of type " + Printable(type.name);
      if (type.Cell() != nullptr && type.Order() != first.Order()) {
        ThrowInputError(mesh_.path,
                        is_of + ", which is " +
                            (type.Order() == 2 ? "quadratic" : "linear") +
                            ", but others are " +
                            (type.Order() == 2 ? "linear" : "quadratic") +
                            "; mesh the specimen with elements of one order");
      }
      if (!type.kind || type.kind != first.kind) {
        ThrowInputError(mesh_.path,
                        is_of + ", but others are of type " +
                            Printable(first.name) +
                            "; mesh the specimen with one kind of element, or "
                            "with elements of one order");
      }
    }
    return *first.kind;
  }

  void CopyWholeElements() {
    const std::size_t num_nodes = mesh_.Topology().num_nodes;
    mesh_.elements.resize(static_cast<Eigen::Index>(num_nodes),
                          static_cast<Eigen::Index>(cells_.size()));
    for (std::size_t k = 0; k < cells_.size(); ++k) {
      const std::vector<int> nodes = NodesOf(*cells_[k], num_nodes);
      std::copy(nodes.begin(), nodes.end(),
                mesh_.elements.col(static_cast<Eigen::Index>(k)).begin());
      first_part_.push_back(static_cast<Eigen::Index>(k));
    }
    first_part_.push_back(mesh_.elements.cols());
  }

  void CutElements() {
    std::vector<FileCell> cells;
    for (const NumberedElement* element : cells_) {
      cells.push_back(
          {TypeOf(*element).Cell(), NodesOf(*element, element->num_nodes)});
    }
    const std::vector<std::size_t> cell_of_part = CutCells(
        cells,
        [this](std::size_t k) {
          return "element " + std::to_string(cells_[k]->number) + " of type " +
                 Printable(TypeOf(*cells_[k]).name);
        },
        mesh_);
    for (std::size_t k = 0; k <= cells_.size(); ++k) {
      first_part_.push_back(
          std::lower_bound(cell_of_part.begin(), cell_of_part.end(), k) -
          cell_of_part.begin());
    }
  }

  /// Returns the nodes of the parts of a cell.
  std::vector<int> NodesOfParts(int place) const {
    const Eigen::MatrixXi nodes = mesh_.elements.middleCols(
        first_part_[place], first_part_[place + 1] - first_part_[place]);
    return {nodes.data(), nodes.data() + nodes.size()};
  }

  /// Appends a face of a cell, in the triangles that it was cut into.
  void AppendFacets(const std::vector<int>& face,
                    std::vector<std::vector<int>>& facets) const {
    if (!are_cut_) {
      facets.push_back(face);
      return;
    }
    const std::vector<std::vector<int>> parts = CutFace(face);
    facets.insert(facets.end(), parts.begin(), parts.end());
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
      if (are_cut_ ||
          int(facet.size()) == mesh_.Topology().NumVerticesOfFace()) {
        AppendFacets(facet, facets);
      }
    }
    AddFacets(facets, group);
  }

  void AddElement(std::size_t number, const std::string& of,
                  PhysicalGroup& group,
                  std::vector<std::vector<int>>& facets) const {
    if (const int place = elements_.Find(number); place >= 0) {
      const std::vector<int> nodes = NodesOfParts(place);
      group.nodes.insert(group.nodes.end(), nodes.begin(), nodes.end());
      return;
    }
    const NumberedElement& element = Other(number, of);
    const std::vector<int> nodes = NodesOf(element, element.num_nodes);
    group.nodes.insert(group.nodes.end(), nodes.begin(), nodes.end());
    if (IsFacet(element)) {
      AppendFacets(VerticesOf(element), facets);
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
           (are_cut_ ||
            type.num_vertices == mesh_.Topology().NumVerticesOfFace());
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
        AppendFacets(VerticesOf(element), facets);
      }
      return;
    }
    if (!face.vertices.empty()) {
      const std::vector<int> nodes =
          NodesOf(*cells_[place], cells_[place]->num_nodes);
      std::vector<int> vertices;
      for (const int vertex : face.vertices) {
        vertices.push_back(nodes[vertex]);
      }
      AppendFacets(vertices, facets);
      return;
    }
    for (Eigen::Index part = first_part_[place]; part < first_part_[place + 1];
         ++part) {
      for (const std::vector<int>& vertices : mesh_.Topology().faces) {
        const Eigen::VectorXi nodes = mesh_.elements(vertices, part);
        const auto [first, last] = std::equal_range(
            Faces().begin(), Faces().end(), OwnedFace{Sorted(nodes), 0, 0});
        if (last - first == 1) {
          facets.emplace_back(nodes.begin(), nodes.end());
        }
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
    std::vector<char> is_member(cells_.size(), 0);
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
  bool are_cut_ = false;
  /// The elements of the file that make up the mesh, by ascending numbers.
  std::vector<const NumberedElement*> cells_;
  /// The first element of the mesh that is a part of each cell, and the end.
  std::vector<Eigen::Index> first_part_;
  std::vector<const NumberedElement*> others_;  ///< By ascending numbers.
  Numbering nodes_{{}};
  Numbering elements_{{}};
  Numbering other_numbers_{{}};
  std::vector<OwnedFace> faces_;
};

}  // namespace

const CellShape* NumberedType::Cell() const {
  const bool is_cut = kind ? Order() == 1 || IsSimplex(*kind) : mend.empty();
  return is_cut ? FindCellShape(dimension, num_vertices) : nullptr;
}

int NumberedType::Order() const {
  return kind ? TopologyOf(*kind).order : has_middles ? 2 : 1;
}

int NumberedType::NumNodes() const {
  if (kind) {
    return TopologyOf(*kind).num_nodes;
  }
  const CellShape* const cell = Cell();
  return cell == nullptr
             ? 0
             : cell->num_vertices + (has_middles ? int(cell->edges.size()) : 0);
}

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
