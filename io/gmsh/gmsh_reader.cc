#include "elastimate/io/gmsh/gmsh_reader.h"

#include <gmsh.h>

#include <algorithm>
#include <exception>
#include <limits>
#include <map>
#include <new>
#include <numeric>
#include <sstream>
#include <stdexcept>
#include <string>
#include <vector>

#include "elastimate/io/text/input_error.h"

namespace elastimate {
namespace {

constexpr int kTriangle = 2;  // Gmsh's element types.
constexpr int kTetrahedron = 4;

void StartGmsh() {
  gmsh::initialize(0, nullptr, false);
  gmsh::option::setNumber("General.Terminal", 0);
  gmsh::logger::start();
}

/// The position of each of Gmsh's numbers in an ascending list of them.
class Numbering {
 public:
  explicit Numbering(std::vector<std::size_t> numbers)
      : numbers_(std::move(numbers)),
        has_no_gap_(std::adjacent_find(numbers_.begin(), numbers_.end(),
                                       [](std::size_t a, std::size_t b) {
                                         return b != a + 1;
                                       }) == numbers_.end()) {}

  /// -1 when `number` is not in the list.
  int Find(std::size_t number) const {
    // As in most files.
    if (has_no_gap_ && !numbers_.empty()) {
      return number < numbers_.front() || number > numbers_.back()
                 ? -1
                 : static_cast<int>(number - numbers_.front());
    }
    const auto found =
        std::lower_bound(numbers_.begin(), numbers_.end(), number);
    return found == numbers_.end() || *found != number
               ? -1
               : static_cast<int>(found - numbers_.begin());
  }
  const std::vector<std::size_t>& Numbers() const { return numbers_; }

 private:
  std::vector<std::size_t> numbers_;
  bool has_no_gap_;
};

/// The permutation that sorts `values`.
std::vector<std::size_t> SortingOrder(const std::vector<std::size_t>& values) {
  std::vector<std::size_t> order(values.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) {
    return values[a] < values[b];
  });
  return order;
}

/// What Gmsh says that the file has; -1 where it says nothing.
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

/// Gmsh 4.8 drops elements of a number it has already, and hides those of
/// another order than the first of their volume.
void CheckNoElementIsLost(const std::filesystem::path& path,
                          Eigen::Index num_elements) {
  std::vector<int> types;
  std::vector<std::vector<std::size_t>> numbers;
  std::vector<std::vector<std::size_t>> corners;
  gmsh::model::mesh::getElements(types, numbers, corners);
  Eigen::Index num_read = 0;
  for (const std::vector<std::size_t>& of_type : numbers) {
    num_read += static_cast<Eigen::Index>(of_type.size());
  }
  if (num_read < num_elements) {
    ThrowInputError(path, "Gmsh can use only " + std::to_string(num_read) +
                              " of its " + std::to_string(num_elements) +
                              " elements; give each a number of its own, and "
                              "all the same order");
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

/// The tetrahedra in ascending order of their element numbers.
Numbering ReadTetrahedra(const Numbering& nodes, MeshFile& mesh) {
  std::vector<int> types;
  std::vector<std::vector<std::size_t>> numbers;
  std::vector<std::vector<std::size_t>> corners;
  gmsh::model::mesh::getElements(types, numbers, corners);
  Numbering tetrahedra({});
  for (std::size_t i = 0; i < types.size(); ++i) {
    if (types[i] != kTetrahedron) {
      mesh.has_other_cells = true;
      continue;
    }
    const std::vector<std::size_t> order = SortingOrder(numbers[i]);
    mesh.tetrahedra.resize(4, order.size());
    std::vector<std::size_t> sorted;
    for (std::size_t k = 0; k < order.size(); ++k) {
      sorted.push_back(numbers[i][order[k]]);
      for (std::size_t corner = 0; corner < 4; ++corner) {
        mesh.tetrahedra(corner, k) =
            NodePosition(mesh, nodes, corners[i][4 * order[k] + corner]);
      }
    }
    tetrahedra = Numbering(std::move(sorted));
  }
  return tetrahedra;
}

void CheckVolumeElements(const std::filesystem::path& path) {
  std::vector<int> types;
  std::vector<std::vector<std::size_t>> numbers;
  std::vector<std::vector<std::size_t>> corners;
  gmsh::model::mesh::getElements(types, numbers, corners, 3);
  for (std::size_t i = 0; i < types.size(); ++i) {
    if (types[i] != kTetrahedron && !numbers[i].empty()) {
      ThrowInputError(path, "element number " + std::to_string(numbers[i][0]) +
                                " is a " + ElementTypeName(types[i]) +
                                ", but only linear tetrahedra are supported; "
                                "mesh the specimen with those");
    }
  }
}

void AddEntity(const Numbering& nodes, int entity, const MeshFile& mesh,
               PhysicalGroup& group) {
  std::vector<int> types;
  std::vector<std::vector<std::size_t>> numbers;
  std::vector<std::vector<std::size_t>> corners;
  gmsh::model::mesh::getElements(types, numbers, corners, group.dimension,
                                 entity);
  for (std::size_t i = 0; i < types.size(); ++i) {
    std::vector<int> positions;
    positions.reserve(corners[i].size());
    for (const std::size_t number : corners[i]) {
      positions.push_back(NodePosition(mesh, nodes, number));
    }
    group.nodes.insert(group.nodes.end(), positions.begin(), positions.end());
    if (types[i] == kTriangle) {
      const Eigen::Index before = group.triangles.cols();
      const Eigen::Index count = numbers[i].size();
      group.triangles.conservativeResize(3, before + count);
      group.triangles.rightCols(count) =
          Eigen::Map<const Eigen::MatrixXi>(positions.data(), 3, count);
    }
  }
}

void ReadPhysicalGroups(const Numbering& nodes, MeshFile& mesh) {
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
      AddEntity(nodes, entity, mesh, group);
    }
    std::sort(group.nodes.begin(), group.nodes.end());
    group.nodes.erase(std::unique(group.nodes.begin(), group.nodes.end()),
                      group.nodes.end());
    mesh.groups.push_back(std::move(group));
  }
}

/// One column per entry of `numbering`; not a number where the file has none.
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

void ReadViews(const Numbering& nodes, const Numbering& tetrahedra,
               MeshFile& mesh) {
  std::vector<int> views;
  gmsh::view::getTags(views);
  for (const int view : views) {
    const std::string option =
        "View[" + std::to_string(gmsh::view::getIndex(view)) + "].";
    std::string name;
    gmsh::option::getString(option + "Name", name);
    if (FindArray(mesh.node_arrays, name) != nullptr ||
        FindArray(mesh.tetrahedron_arrays, name) != nullptr) {
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
      mesh.tetrahedron_arrays.push_back(
          {name, Scatter(numbers, data, num_components, tetrahedra)});
    }
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
    CheckVolumeElements(path);
    CheckNoElementIsLost(path, counts.elements);
    const Numbering nodes = ReadNodes(mesh);
    mesh.num_nodes_left_out =
        std::max<Eigen::Index>(counts.nodes - mesh.nodes.cols(), 0);
    const Numbering tetrahedra = ReadTetrahedra(nodes, mesh);
    ReadPhysicalGroups(nodes, mesh);
    ReadViews(nodes, tetrahedra, mesh);
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
