#include "elastimate/io/gmsh/gmsh_reader.h"

#include <gmsh.h>

#include <algorithm>
#include <array>
#include <exception>
#include <limits>
#include <map>
#include <new>
#include <sstream>
#include <stdexcept>
#include <string>
#include <vector>

#include "elastimate/io/mesh/cut_cells.h"
#include "elastimate/io/mesh/numbering.h"
#include "elastimate/io/mesh/simplices.h"
#include "elastimate/io/text/input_error.h"
#include "elastimate/io/text/printable.h"

namespace elastimate {
namespace {

/// Gmsh's types of elements and of their facets.
struct GmshKind {
  ElementKind kind;
  int type;
  int facet_type;
};

constexpr std::array<GmshKind, 8> kGmshKinds = {{
    {ElementKind::kTet4, 4, 2},
    {ElementKind::kTet10, 11, 9},
    {ElementKind::kHex8, 5, 3},
    {ElementKind::kHex27, 12, 10},
    {ElementKind::kTri3, 2, 1},
    {ElementKind::kTri6, 9, 8},
    {ElementKind::kQuad4, 3, 1},
    {ElementKind::kQuad9, 10, 8},
}};

/// The place in Gmsh's hexahedron of 27 nodes of each node in VTK's order.
constexpr std::array<int, 27> kHexahedronInGmsh = {
    0,  1,  2,  3,  4,  5,  6,  7,  8,  11, 13, 9,  16, 18,
    19, 17, 10, 12, 14, 15, 22, 23, 21, 24, 20, 25, 26};

/// What an element may be cut as.
struct GmshCell {
  int type;
  int dimension;
  int num_vertices;
  /// The places in Gmsh's element of the nodes in the middle of edges, in the
  /// order of CellShape; empty in linear elements.
  std::vector<int> middles;

  const CellShape* Shape() const {
    return FindCellShape(dimension, num_vertices);
  }
  int NumNodes() const { return num_vertices + int(middles.size()); }
};

/// Returns null for elements of types that cannot be cut.
const GmshCell* FindGmshCell(int type) {
  static const std::vector<GmshCell> cells = {
      {2, 2, 3, {}},
      {3, 2, 4, {}},
      {4, 3, 4, {}},
      {5, 3, 8, {}},
      {6, 3, 6, {}},
      {7, 3, 5, {}},
      {9, 2, 3, {3, 4, 5}},
      {16, 2, 4, {4, 5, 6, 7}},
      {11, 3, 4, {4, 5, 6, 7, 9, 8}},
      {17, 3, 8, {8, 11, 13, 9, 16, 18, 19, 17, 10, 12, 14, 15}},
      {18, 3, 6, {6, 9, 7, 12, 14, 13, 8, 10, 11}},
      {19, 3, 5, {5, 8, 10, 6, 7, 9, 11, 12}}};
  const auto found =
      std::find_if(cells.begin(), cells.end(),
                   [&](const GmshCell& one) { return one.type == type; });
  return found == cells.end() ? nullptr : &*found;
}

/// Returns null where elements of this type are not for scenes.
const GmshKind* FindGmshKind(int type) {
  const auto* const found =
      std::find_if(kGmshKinds.begin(), kGmshKinds.end(),
                   [&](const GmshKind& one) { return one.type == type; });
  return found == kGmshKinds.end() ? nullptr : found;
}

void StartGmsh() {
  gmsh::initialize(0, nullptr, false);
  gmsh::option::setNumber("General.Terminal", 0);
  gmsh::logger::start();
}

/// The counts that Gmsh says the file has; -1 where it says nothing.
struct FileCounts {
  Eigen::Index nodes = -1;
  Eigen::Index elements = -1;
};

/// The count in a line like "Info: 12 nodes", or `otherwise`.
Eigen::Index CountIn(const std::string& line, const std::string& unit,
                     Eigen::Index otherwise) {
  std::istringstream words(line);
  std::string info;
  std::string last;
  Eigen::Index count = 0;
  return words >> info >> count >> last && info == "Info:" && last == unit &&
                 words.eof()
             ? count
             : otherwise;
}

[[noreturn]] void ThrowSaidByGmsh(const std::filesystem::path& link,
                                  const std::filesystem::path& path,
                                  std::string message) {
  const std::size_t place = message.find(link.string());
  if (place != std::string::npos) {
    message.replace(place, link.string().size(), path.filename().string());
  }
  ThrowDamagedFile(path, message);
}

FileCounts Merge(const std::filesystem::path& link,
                 const std::filesystem::path& path) {
  gmsh::merge(link.string());
  std::vector<std::string> log;
  gmsh::logger::get(log);
  FileCounts counts;
  for (const std::string& line : log) {
    if (line.rfind("Error: ", 0) == 0) {
      ThrowSaidByGmsh(link, path, line.substr(7));
    }
    counts.nodes = CountIn(line, "nodes", counts.nodes);
    counts.elements = CountIn(line, "elements", counts.elements);
  }
  return counts;
}

/// The elements of some dimension (of all for -1), by their types.
struct GmshElements {
  explicit GmshElements(int dimension, int entity = -1) {
    gmsh::model::mesh::getElements(types, numbers, nodes, dimension, entity);
  }

  std::vector<int> types;
  std::vector<std::vector<std::size_t>> numbers;
  std::vector<std::vector<std::size_t>> nodes;
};

Eigen::Index NumElementsOfAnyDimension() {
  Eigen::Index count = 0;
  for (const std::vector<std::size_t>& of_type : GmshElements(-1).numbers) {
    count += static_cast<Eigen::Index>(of_type.size());
  }
  return count;
}

/// Gmsh 4.8 drops elements of a number it has already, and hides those of
/// another order than the first of their volume.
void CheckNoElementIsLost(const std::filesystem::path& path,
                          Eigen::Index num_elements) {
  const Eigen::Index num_read = NumElementsOfAnyDimension();
  if (num_read < num_elements) {
    ThrowInputError(path, "Gmsh can use only " + std::to_string(num_read) +
                              " of its " + std::to_string(num_elements) +
                              " elements; give each element its own number, "
                              "and all elements the same order");
  }
}

Numbering ReadNodes(MeshFile& mesh) {
  std::vector<std::size_t> numbers;
  std::vector<double> positions;
  std::vector<double> unused;
  gmsh::model::mesh::getNodes(numbers, positions, unused);
  if (numbers.size() > std::numeric_limits<int>::max()) {
    ThrowInputError(mesh.path, "the mesh has more than 2^31 nodes; coarsen it");
  }
  const std::vector<std::size_t> order = SortingOrder(numbers);
  mesh.nodes = Eigen::Map<const Eigen::Matrix3Xd>(
      positions.data(), 3, numbers.size())(Eigen::all, order);
  for (const std::size_t i : order) {
    mesh.node_numbers.push_back(numbers[i]);
  }
  const auto twin =
      std::adjacent_find(mesh.node_numbers.begin(), mesh.node_numbers.end());
  if (twin != mesh.node_numbers.end()) {
    ThrowDamagedFile(mesh.path, "it has the node number " +
                                    std::to_string(*twin) + " twice");
  }
  return Numbering(mesh.node_numbers);
}

int NodePosition(const std::filesystem::path& path, const Numbering& nodes,
                 std::size_t number) {
  const int node = nodes.Find(number);
  if (node < 0) {
    ThrowDamagedFile(path, "an element names node number " +
                               std::to_string(number) +
                               ", which the file does not have");
  }
  return node;
}

std::string ElementTypeName(int type) {
  std::string name;
  int dimension = 0;
  int order = 0;
  int num_nodes = 0;
  int num_primary_nodes = 0;
  std::vector<double> local_positions;
  gmsh::model::mesh::getElementProperties(type, name, dimension, order,
                                          num_nodes, local_positions,
                                          num_primary_nodes);
  return name;
}

/// The elements of dimension 3 where there are any, else of dimension 2, in
/// ascending order of their numbers, and what they become in a scene.
class GmshCells {
 public:
  GmshCells(const std::filesystem::path& path, const GmshElements& elements)
      : path_(path), elements_(elements) {
    std::vector<std::size_t> numbers;
    for (std::size_t i = 0; i < elements.types.size(); ++i) {
      for (std::size_t k = 0; k < elements.numbers[i].size(); ++k) {
        cells_.push_back({i, k});
        numbers.push_back(elements.numbers[i][k]);
      }
    }
    std::vector<Cell> sorted;
    for (const std::size_t i : SortingOrder(numbers)) {
      sorted.push_back(cells_[i]);
    }
    cells_ = std::move(sorted);
    std::sort(numbers.begin(), numbers.end());
    numbering_ = Numbering(std::move(numbers));
    are_cut_ = AreToBeCut();
    if (!are_cut_ && !cells_.empty()) {
      CheckOneKind();
    }
  }

  bool Empty() const { return cells_.empty(); }
  bool AreCut() const { return are_cut_; }
  const Numbering& Numbers() const { return numbering_; }

  void EnterElements(const Numbering& nodes, MeshFile& mesh) {
    if (are_cut_) {
      CutElements(nodes, mesh);
    } else {
      CopyElements(nodes, mesh);
    }
    for (std::size_t k = 0; k < cells_.size() && !are_cut_; ++k) {
      mesh.element_numbers.push_back(NumberOf(cells_[k]));
    }
    for (const std::size_t k : cell_of_part_) {
      mesh.element_numbers.push_back(NumberOf(cells_[k]));
    }
  }

  /// Gives each element the column of its cell.
  void SpreadOverParts(std::vector<FileArray>& arrays) const {
    for (FileArray& array : arrays) {
      if (are_cut_) {
        array.values = Eigen::MatrixXd(array.values(Eigen::all, cell_of_part_));
      }
    }
  }

  /// Returns the name of the cell at a place, which is the first part of it
  /// where cells are cut.
  std::string NameOfElement(int place, const MeshFile& mesh) const {
    return ElementName(mesh, !are_cut_ ? place
                                       : std::lower_bound(cell_of_part_.begin(),
                                                          cell_of_part_.end(),
                                                          std::size_t(place)) -
                                             cell_of_part_.begin());
  }

 private:
  struct Cell {
    std::size_t type;   // The place in elements_.
    std::size_t place;  // Among those of the type.
  };

  std::size_t NumberOf(const Cell& cell) const {
    return elements_.numbers[cell.type][cell.place];
  }

  void CopyElements(const Numbering& nodes, MeshFile& mesh) const {
    mesh.kind = FindGmshKind(TypeOf(cells_[0]))->kind;
    const int num_nodes = mesh.Topology().num_nodes;
    mesh.elements.resize(num_nodes, Eigen::Index(cells_.size()));
    for (std::size_t k = 0; k < cells_.size(); ++k) {
      const std::vector<int> of_cell = NodesOf(cells_[k], num_nodes, nodes);
      std::copy(of_cell.begin(), of_cell.end(),
                mesh.elements.col(Eigen::Index(k)).begin());
    }
    if (mesh.kind == ElementKind::kTet10) {
      // Gmsh has the middle of edge 23 before that of 13.
      mesh.elements.row(8).swap(mesh.elements.row(9));
    }
    if (mesh.kind == ElementKind::kHex27) {
      mesh.elements = mesh.elements(kHexahedronInGmsh, Eigen::all).eval();
    }
  }

  int TypeOf(const Cell& cell) const { return elements_.types[cell.type]; }

  std::string NameOf(const Cell& cell) const {
    return "element number " + std::to_string(NumberOf(cell)) + " is a " +
           ElementTypeName(TypeOf(cell));
  }

  /// Tells whether all may be cut into simplices, and are not of one kind
  /// otherwise.
  bool AreToBeCut() const {
    return std::all_of(
               cells_.begin(), cells_.end(),
               [this](const Cell& cell) {
                 const GmshCell* const one = FindGmshCell(TypeOf(cell));
                 return one != nullptr &&
                        one->middles.empty() ==
                            FindGmshCell(TypeOf(cells_[0]))->middles.empty();
               }) &&
           std::any_of(cells_.begin(), cells_.end(), [this](const Cell& cell) {
             return FindGmshKind(TypeOf(cell)) == nullptr ||
                    cell.type != cells_[0].type;
           });
  }

  void CheckOneKind() const {
    for (const Cell& cell : cells_) {
      if (FindGmshKind(TypeOf(cell)) == nullptr &&
          FindGmshCell(TypeOf(cell)) == nullptr) {
        ThrowInputError(
            path_, NameOf(cell) + ", but the elements of a scene are " +
                       kSupportedElements + "; mesh the specimen with these");
      }
      if (cell.type != cells_[0].type) {
        ThrowInputError(path_, NameOf(cell) + ", but others are of type " +
                                   ElementTypeName(TypeOf(cells_[0])) +
                                   "; mesh the specimen with one kind of "
                                   "element, or with elements of one order");
      }
    }
  }

  std::vector<int> NodesOf(const Cell& cell, int count,
                           const Numbering& nodes) const {
    std::vector<int> positions;
    positions.reserve(std::size_t(count));
    for (int i = 0; i < count; ++i) {
      positions.push_back(NodePosition(
          path_, nodes,
          elements_.nodes[cell.type]
                         [std::size_t(count) * cell.place + std::size_t(i)]));
    }
    return positions;
  }

  void CutElements(const Numbering& nodes, MeshFile& mesh) {
    std::vector<FileCell> to_cut;
    for (const Cell& cell : cells_) {
      const GmshCell& one = *FindGmshCell(TypeOf(cell));
      const std::vector<int> in_file = NodesOf(cell, one.NumNodes(), nodes);
      std::vector<int> of_cell(in_file.begin(),
                               in_file.begin() + one.num_vertices);
      for (const int place : one.middles) {
        of_cell.push_back(in_file[place]);
      }
      to_cut.push_back({one.Shape(), std::move(of_cell)});
    }
    cell_of_part_ = CutCells(
        to_cut, [this](std::size_t k) { return NameOf(cells_[k]) + " that"; },
        mesh);
  }

  const std::filesystem::path path_;
  const GmshElements& elements_;
  std::vector<Cell> cells_;
  Numbering numbering_{{}};
  bool are_cut_ = false;
  std::vector<std::size_t> cell_of_part_;
};

/// Appends facets, the vertices of which come first in the columns, each in the
/// parts into which it is cut.
void AppendCutFacets(const Eigen::MatrixXi& facets, PhysicalGroup& group,
                     Eigen::Index num_vertices) {
  for (const auto& facet : facets.colwise()) {
    for (const std::vector<int>& part :
         CutFace(std::vector<int>(facet.begin(), facet.end()))) {
      group.facets.conservativeResize(num_vertices, group.facets.cols() + 1);
      std::copy(part.begin(), part.end(), group.facets.rightCols<1>().begin());
    }
  }
}

void AddEntity(const Numbering& nodes, int entity, bool are_cut,
               const MeshFile& mesh, PhysicalGroup& group) {
  const GmshElements elements(group.dimension, entity);
  const int facet_type =
      std::find_if(kGmshKinds.begin(), kGmshKinds.end(),
                   [&](const GmshKind& one) { return one.kind == mesh.kind; })
          ->facet_type;
  const Eigen::Index num_nodes = mesh.Topology().NumNodesOfFace();
  const Eigen::Index num_vertices = mesh.Topology().NumVerticesOfFace();
  for (std::size_t i = 0; i < elements.types.size(); ++i) {
    std::vector<int> positions;
    positions.reserve(elements.nodes[i].size());
    for (const std::size_t number : elements.nodes[i]) {
      positions.push_back(NodePosition(mesh.path, nodes, number));
    }
    group.nodes.insert(group.nodes.end(), positions.begin(), positions.end());
    const GmshCell* const facet = FindGmshCell(elements.types[i]);
    const Eigen::Index count = Eigen::Index(elements.numbers[i].size());
    if (are_cut && facet != nullptr && group.dimension == 2 &&
        mesh.Dimension() == 3) {
      AppendCutFacets(Eigen::Map<const Eigen::MatrixXi>(
                          positions.data(), facet->NumNodes(), count)
                          .topRows(facet->num_vertices),
                      group, num_vertices);
    } else if (elements.types[i] == facet_type) {
      const Eigen::Index before = group.facets.cols();
      group.facets.conservativeResize(num_vertices, before + count);
      group.facets.rightCols(count) =
          Eigen::Map<const Eigen::MatrixXi>(positions.data(), num_nodes, count)
              .topRows(num_vertices);
    }
  }
}

void ReadPhysicalGroups(const Numbering& nodes, bool are_cut, MeshFile& mesh) {
  gmsh::vectorpair groups;
  gmsh::model::getPhysicalGroups(groups);
  for (const auto& [dimension, number] : groups) {
    PhysicalGroup group;
    group.dimension = dimension;
    group.number = number;
    gmsh::model::getPhysicalName(dimension, number, group.name);
    std::vector<int> entities;
    gmsh::model::getEntitiesForPhysicalGroup(dimension, number, entities);
    for (const int entity : entities) {
      AddEntity(nodes, entity, are_cut, mesh, group);
    }
    std::sort(group.nodes.begin(), group.nodes.end());
    group.nodes.erase(std::unique(group.nodes.begin(), group.nodes.end()),
                      group.nodes.end());
    AddNodesBetween(mesh, group.nodes);
    mesh.groups.push_back(std::move(group));
  }
}

/// Returns one column per entry of `numbering`, with NaN where the file has
/// none.
Eigen::MatrixXd Scatter(const std::vector<std::size_t>& numbers,
                        const std::vector<double>& data, int num_components,
                        const Numbering& numbering) {
  Eigen::MatrixXd values =
      Eigen::MatrixXd::Constant(num_components, numbering.Numbers().size(),
                                std::numeric_limits<double>::quiet_NaN());
  for (std::size_t i = 0; i < numbers.size(); ++i) {
    const int position = numbering.Find(numbers[i]);
    if (position >= 0) {
      values.col(position) = Eigen::Map<const Eigen::VectorXd>(
          &data[i * num_components], num_components);
    }
  }
  return values;
}

void CheckNodesOfData(const MeshFile& mesh, const Numbering& nodes,
                      const std::string& name,
                      const std::vector<std::size_t>& numbers) {
  // Nodes that Gmsh left out may have data all the same.
  for (std::size_t i = 0; i < numbers.size() && mesh.num_nodes_left_out == 0;
       ++i) {
    if (nodes.Find(numbers[i]) < 0) {
      ThrowInputError(mesh.path, "its data '" + name + "' name node number " +
                                     std::to_string(numbers[i]) +
                                     ", which the file does not have; correct "
                                     "them");
    }
  }
}

void ReadViews(const Numbering& nodes, const Numbering& elements,
               MeshFile& mesh) {
  std::vector<int> views;
  gmsh::view::getTags(views);
  for (const int view : views) {
    const std::string option =
        "View[" + std::to_string(gmsh::view::getIndex(view)) + "].";
    std::string name;
    gmsh::option::getString(option + "Name", name);
    if (FindArray(mesh.node_arrays, name) != nullptr ||
        FindArray(mesh.element_arrays, name) != nullptr) {
      ThrowInputError(mesh.path,
                      "it has the data '" + name + "' twice; keep one");
    }
    double num_steps = 0;
    gmsh::option::getNumber(option + "NbTimeStep", num_steps);
    if (num_steps != 1) {
      ThrowInputError(mesh.path, "its data '" + name +
                                     "' has several time steps; keep one");
    }
    std::string kind;
    std::vector<std::size_t> numbers;
    std::vector<double> data;
    double time = 0;
    int num_components = 0;
    gmsh::view::getHomogeneousModelData(view, 0, kind, numbers, data, time,
                                        num_components);
    if (num_components < 1 || data.size() != numbers.size() * num_components) {
      ThrowDamagedFile(mesh.path, "its data '" + name + "' cannot be read");
    }
    if (kind == "NodeData") {
      CheckNodesOfData(mesh, nodes, name, numbers);
      mesh.node_arrays.push_back(
          {name, Scatter(numbers, data, num_components, nodes)});
    } else if (kind == "ElementData") {
      mesh.element_arrays.push_back(
          {name, Scatter(numbers, data, num_components, elements)});
    }
  }
}

std::string GroupName(const MeshFile& mesh, int number) {
  const auto group = std::find_if(
      mesh.groups.begin(), mesh.groups.end(), [&](const PhysicalGroup& one) {
        return one.dimension == mesh.Dimension() && one.number == number;
      });
  return std::to_string(number) +
         (group == mesh.groups.end() || group->name.empty()
              ? ""
              : " \"" + Printable(group->name) + "\"");
}

/// Enters `number` for the elements of the entity, or notes which of them has
/// another number already.
void EnterRegion(int number, int entity, const GmshCells& cells,
                 Eigen::MatrixXd& regions, MeshFile& mesh) {
  const Numbering& elements = cells.Numbers();
  for (const std::vector<std::size_t>& of_type :
       GmshElements(mesh.Dimension(), entity).numbers) {
    for (const std::size_t element : of_type) {
      double& region = regions(elements.Find(element));
      if (region != 0 && region != number && mesh.why_no_regions.empty()) {
        mesh.why_no_regions =
            cells.NameOfElement(elements.Find(element), mesh) +
            " is in the physical groups " +
            GroupName(mesh, static_cast<int>(region)) + " and " +
            GroupName(mesh, number);
      }
      region = number;
    }
  }
}

/// Makes the physical groups of the elements the array `region`, where the file
/// has none and no element is in two of them.
void ReadRegions(const GmshCells& cells, MeshFile& mesh) {
  gmsh::vectorpair groups;
  gmsh::model::getPhysicalGroups(groups, mesh.Dimension());
  if (groups.empty() || FindArray(mesh.element_arrays, "region") != nullptr) {
    return;
  }
  Eigen::MatrixXd regions =
      Eigen::MatrixXd::Zero(1, Eigen::Index(cells.Numbers().Numbers().size()));
  for (const auto& [dimension, number] : groups) {
    std::vector<int> entities;
    gmsh::model::getEntitiesForPhysicalGroup(dimension, number, entities);
    for (const int entity : entities) {
      EnterRegion(number, entity, cells, regions, mesh);
    }
  }
  mesh.are_regions_groups = mesh.why_no_regions.empty();
  if (mesh.are_regions_groups) {
    mesh.element_arrays.push_back({"region", regions});
  }
}

}  // namespace

MeshFile ReadByGmsh(const std::filesystem::path& link,
                    const std::filesystem::path& path) {
  MeshFile mesh;
  mesh.path = path;
  mesh.is_vtk = false;
  try {
    StartGmsh();
    const FileCounts counts = Merge(link, path);
    const int dimension = GmshElements(3).types.empty() ? 2 : 3;
    const GmshElements gmsh_elements(dimension);
    GmshCells cells(path, gmsh_elements);
    CheckNoElementIsLost(path, counts.elements);
    const Numbering nodes = ReadNodes(mesh);
    mesh.num_nodes_left_out =
        std::max<Eigen::Index>(counts.nodes - mesh.nodes.cols(), 0);
    if (cells.Empty()) {
      return mesh;
    }
    cells.EnterElements(nodes, mesh);
    ReadPhysicalGroups(nodes, cells.AreCut(), mesh);
    ReadViews(nodes, cells.Numbers(), mesh);
    ExtendNodeArrays(mesh);
    ReadRegions(cells, mesh);
    cells.SpreadOverParts(mesh.element_arrays);
    mesh.has_other_cells = NumElementsOfAnyDimension() >
                           Eigen::Index(cells.Numbers().Numbers().size());
  } catch (const std::string& message) {
    ThrowSaidByGmsh(link, path, message);  // Gmsh throws strings.
  } catch (const std::bad_alloc&) {
    throw;
  } catch (const std::invalid_argument&) {
    throw;
  } catch (const std::exception& error) {
    ThrowSaidByGmsh(link, path, error.what());
  }
  return mesh;
}

}  // namespace elastimate
