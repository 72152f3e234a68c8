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

#include "elastimate/io/mesh/numbering.h"
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

int NodePosition(const MeshFile& mesh, const Numbering& nodes,
                 std::size_t number) {
  const int node = nodes.Find(number);
  if (node < 0) {
    ThrowDamagedFile(mesh.path, "an element names node number " +
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

/// Returns the kind of the elements of dimension 3 where there are any, else of
/// dimension 2; they have to be of one kind.  Returns null where there are
/// none.
const GmshKind* FindKind(const std::filesystem::path& path,
                         const GmshElements& elements) {
  const GmshKind* kind = nullptr;
  for (std::size_t i = 0; i < elements.types.size(); ++i) {
    if (elements.numbers[i].empty()) {
      continue;
    }
    const std::string name = "element number " +
                             std::to_string(elements.numbers[i][0]) + " is a " +
                             ElementTypeName(elements.types[i]);
    const GmshKind* const other = FindGmshKind(elements.types[i]);
    if (other == nullptr) {
      ThrowInputError(path, name + ", but the elements of a scene are " +
                                kSupportedElements +
                                "; mesh the specimen with one kind of these");
    }
    if (kind != nullptr) {
      ThrowInputError(path, name + ", but others are of type " +
                                ElementTypeName(kind->type) +
                                "; mesh the specimen with one kind of element");
    }
    kind = other;
  }
  return kind;
}

/// Reads the elements in ascending order of their numbers.
Numbering ReadElements(const GmshElements& elements, const Numbering& nodes,
                       MeshFile& mesh) {
  const Eigen::Index num_nodes = mesh.Topology().num_nodes;
  for (std::size_t i = 0; i < elements.types.size(); ++i) {
    if (elements.numbers[i].empty()) {
      continue;
    }
    const std::vector<std::size_t> order = SortingOrder(elements.numbers[i]);
    mesh.elements.resize(num_nodes, order.size());
    std::vector<std::size_t> sorted;
    for (std::size_t k = 0; k < order.size(); ++k) {
      sorted.push_back(elements.numbers[i][order[k]]);
      for (Eigen::Index n = 0; n < num_nodes; ++n) {
        mesh.elements(n, k) = NodePosition(
            mesh, nodes, elements.nodes[i][num_nodes * order[k] + n]);
      }
    }
    if (mesh.kind == ElementKind::kTet10) {
      // Gmsh has the middle of edge 23 before that of 13.
      mesh.elements.row(8).swap(mesh.elements.row(9));
    }
    if (mesh.kind == ElementKind::kHex27) {
      mesh.elements = mesh.elements(kHexahedronInGmsh, Eigen::all).eval();
    }
    return Numbering(std::move(sorted));
  }
  return Numbering({});
}

void AddEntity(const Numbering& nodes, int entity, int facet_type,
               const MeshFile& mesh, PhysicalGroup& group) {
  const GmshElements elements(group.dimension, entity);
  const Eigen::Index num_nodes = mesh.Topology().NumNodesOfFace();
  const Eigen::Index num_vertices = mesh.Topology().NumVerticesOfFace();
  for (std::size_t i = 0; i < elements.types.size(); ++i) {
    std::vector<int> positions;
    positions.reserve(elements.nodes[i].size());
    for (const std::size_t number : elements.nodes[i]) {
      positions.push_back(NodePosition(mesh, nodes, number));
    }
    group.nodes.insert(group.nodes.end(), positions.begin(), positions.end());
    if (elements.types[i] == facet_type) {
      const Eigen::Index before = group.facets.cols();
      const Eigen::Index count = elements.numbers[i].size();
      group.facets.conservativeResize(num_vertices, before + count);
      group.facets.rightCols(count) =
          Eigen::Map<const Eigen::MatrixXi>(positions.data(), num_nodes, count)
              .topRows(num_vertices);
    }
  }
}

void ReadPhysicalGroups(const Numbering& nodes, int facet_type,
                        MeshFile& mesh) {
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
      AddEntity(nodes, entity, facet_type, mesh, group);
    }
    std::sort(group.nodes.begin(), group.nodes.end());
    group.nodes.erase(std::unique(group.nodes.begin(), group.nodes.end()),
                      group.nodes.end());
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
void EnterRegion(int number, int entity, const Numbering& elements,
                 Eigen::MatrixXd& regions, MeshFile& mesh) {
  for (const std::vector<std::size_t>& of_type :
       GmshElements(mesh.Dimension(), entity).numbers) {
    for (const std::size_t element : of_type) {
      double& region = regions(elements.Find(element));
      if (region != 0 && region != number && mesh.why_no_regions.empty()) {
        mesh.why_no_regions = mesh.Shape() + " " +
                              std::to_string(elements.Find(element)) +
                              " is in the physical groups " +
                              GroupName(mesh, static_cast<int>(region)) +
                              " and " + GroupName(mesh, number);
      }
      region = number;
    }
  }
}

/// Makes the physical groups of the elements the array `region`, where the file
/// has none and no element is in two of them.
void ReadRegions(const Numbering& elements, MeshFile& mesh) {
  gmsh::vectorpair groups;
  gmsh::model::getPhysicalGroups(groups, mesh.Dimension());
  if (groups.empty() || FindArray(mesh.element_arrays, "region") != nullptr) {
    return;
  }
  Eigen::MatrixXd regions = Eigen::MatrixXd::Zero(1, mesh.elements.cols());
  for (const auto& [dimension, number] : groups) {
    std::vector<int> entities;
    gmsh::model::getEntitiesForPhysicalGroup(dimension, number, entities);
    for (const int entity : entities) {
      EnterRegion(number, entity, elements, regions, mesh);
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
    const GmshKind* const kind = FindKind(path, gmsh_elements);
    CheckNoElementIsLost(path, counts.elements);
    const Numbering nodes = ReadNodes(mesh);
    mesh.num_nodes_left_out =
        std::max<Eigen::Index>(counts.nodes - mesh.nodes.cols(), 0);
    if (kind == nullptr) {
      return mesh;
    }
    mesh.kind = kind->kind;
    const Numbering elements = ReadElements(gmsh_elements, nodes, mesh);
    ReadPhysicalGroups(nodes, kind->facet_type, mesh);
    ReadViews(nodes, elements, mesh);
    ReadRegions(elements, mesh);
    mesh.has_other_cells = NumElementsOfAnyDimension() > mesh.elements.cols();
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
