#include "elastimate/io/mesh/mesh_file.h"

#include <boost/algorithm/string/predicate.hpp>
#include <cctype>

#include "elastimate/core/text/numbers.h"
#include "elastimate/io/text/input_error.h"

namespace elastimate {

std::string FileExtension(const std::filesystem::path& path) {
  std::string small = path.extension().string();
  std::string capital = small;
  for (char& c : small) {
    c = static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
  }
  for (char& c : capital) {
    c = static_cast<char>(std::toupper(static_cast<unsigned char>(c)));
  }
  return path.extension() == capital ? small : path.extension().string();
}

std::string ArrayNames(const std::vector<FileArray>& arrays) {
  std::string names;
  for (const FileArray& array : arrays) {
    names += (names.empty() ? "" : ", ") + Printable(array.name);
  }
  return names.empty() ? "none" : names;
}

std::string ProgramOf(const MeshFile& mesh) {
  return mesh.node_numbers.empty() ? ""
         : mesh.sets_of.empty()    ? "Gmsh"
                                   : mesh.sets_of;
}

std::string NodeName(const MeshFile& mesh, Eigen::Index node) {
  if (mesh.node_numbers.empty()) {
    return "node " + std::to_string(node);
  }
  return "node " + std::to_string(node) + " (number " +
         std::to_string(mesh.node_numbers[node]) + " in " + ProgramOf(mesh) +
         ")";
}

std::string ElementName(const MeshFile& mesh, Eigen::Index element) {
  const std::string name = mesh.Shape() + " " + std::to_string(element);
  if (mesh.element_numbers.empty()) {
    return name;
  }
  const std::string number = std::to_string(mesh.element_numbers[element]);
  return name + (mesh.is_cut ? " (of " : " (") +
         (mesh.is_vtk ? "cell " + number
                      : "number " + number + " in " + ProgramOf(mesh)) +
         ")";
}

Eigen::VectorXd ValuesAt(const AddedNode& added,
                         const Eigen::MatrixXd& values) {
  return values(Eigen::all, added.around) *
         Eigen::Map<const Eigen::VectorXd>(added.weights.data(),
                                           Eigen::Index(added.weights.size()));
}

void ExtendNodeArrays(MeshFile& mesh) {
  for (FileArray& array : mesh.node_arrays) {
    Eigen::Index column = array.values.cols();
    array.values.conservativeResize(Eigen::NoChange, mesh.nodes.cols());
    for (const AddedNode& added : mesh.added) {
      array.values.col(column++) = ValuesAt(added, array.values);
    }
  }
}

bool AreSameNames(const MeshFile& mesh, const std::string& name,
                  const std::string& other) {
  return mesh.sets_of.empty() ? name == other : boost::iequals(name, other);
}

void RequireNodePositions(const MeshFile& mesh) {
  if (mesh.num_nodes_left_out > 0) {
    ThrowInputError(
        mesh.path,
        "Gmsh leaves out " +
            Counted(std::size_t(mesh.num_nodes_left_out), "node") +
            " that no element uses, so that the order of the nodes in the "
            "file is lost; save the mesh without such nodes (gmsh -save "
            "does)");
  }
}

}  // namespace elastimate
