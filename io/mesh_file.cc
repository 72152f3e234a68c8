#include "elastimate/io/mesh_file.h"

#include <algorithm>
#include <array>
#include <cctype>
#include <fstream>
#include <numeric>
#include <set>
#include <system_error>
#include <utility>
#include <vector>

#include "elastimate/io/gmsh_mesh.h"
#include "elastimate/io/input_error.h"
#include "elastimate/io/vtk_mesh.h"

namespace elastimate {
namespace {

void MarkUsedNodes(MeshFile& mesh) {
  mesh.used.setConstant(mesh.nodes.cols(), false);
  for (const int node : mesh.tetrahedra.reshaped()) {
    mesh.used[node] = true;
  }
}

void CheckPositions(const MeshFile& mesh) {
  for (Eigen::Index node = 0; node < mesh.nodes.cols(); ++node) {
    if (mesh.used[node] && !mesh.nodes.col(node).allFinite()) {
      ThrowInputError(mesh.path, "the position of " + NodeName(mesh, node) +
                                     " is not a finite number; correct it");
    }
  }
}

/// A tetrahedron that comes twice is twice as stiff.
void CheckTetrahedraDiffer(const MeshFile& mesh) {
  // Ordered by the smallest node, which few have in common.
  std::vector<Eigen::Index> end(mesh.nodes.cols() + 1, 0);
  for (Eigen::Index i = 0; i < mesh.tetrahedra.cols(); ++i) {
    ++end[mesh.tetrahedra.col(i).minCoeff() + 1];
  }
  std::partial_sum(end.begin(), end.end(), end.begin());
  std::vector<Eigen::Index> order(mesh.tetrahedra.cols());
  for (Eigen::Index i = 0; i < mesh.tetrahedra.cols(); ++i) {
    order[end[mesh.tetrahedra.col(i).minCoeff()]++] = i;
  }
  // The nodes of those of one smallest node, ascending, and their indices.
  std::vector<std::pair<std::array<int, 4>, Eigen::Index>> some;
  Eigen::Index first = 0;
  for (Eigen::Index node = 0; node < mesh.nodes.cols(); ++node) {
    some.clear();
    for (; first < end[node]; ++first) {
      const auto corners = mesh.tetrahedra.col(order[first]);
      some.push_back(
          {{corners(0), corners(1), corners(2), corners(3)}, order[first]});
      std::sort(some.back().first.begin(), some.back().first.end());
    }
    std::sort(some.begin(), some.end());
    const auto twin = std::adjacent_find(
        some.begin(), some.end(),
        [](const auto& a, const auto& b) { return a.first == b.first; });
    if (twin != some.end()) {
      ThrowInputError(
          mesh.path,
          "tetrahedra " + std::to_string(twin->second) + " and " +
              std::to_string((twin + 1)->second) + " have the same nodes; " +
              (mesh.is_vtk ? "keep one of them"
                           : "save the mesh as .msh of version 4 (older ones "
                             "repeat what is in several physical groups)"));
    }
  }
}

}  // namespace

MeshFile ReadMeshFile(const std::filesystem::path& path) {
  CheckReadable(path);
  const std::string extension = FileExtension(path);
  MeshFile mesh;
  if (extension == ".vtu") {
    mesh = ReadVtuMesh(path);
  } else if (extension == ".vtk") {
    mesh = ReadLegacyVtkMesh(path);
  } else if (std::set<std::string>{".msh", ".mesh", ".unv", ".bdf"}.count(
                 extension) > 0) {
    mesh = ReadGmshMesh(path);
  } else {
    ThrowInputError(path,
                    "the file name does not end in .vtu, .vtk, .msh, .mesh, "
                    ".unv or .bdf (a mesh) or in .json (a scene); give a file "
                    "of one of these formats");
  }
  if (mesh.tetrahedra.cols() == 0) {
    ThrowInputError(path,
                    "the mesh has no tetrahedra; give a volume mesh of "
                    "linear tetrahedra");
  }
  mesh.path = path;
  MarkUsedNodes(mesh);
  CheckPositions(mesh);
  CheckTetrahedraDiffer(mesh);
  return mesh;
}

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

void CheckReadable(const std::filesystem::path& path) {
  std::error_code error;
  const std::filesystem::file_status status =
      std::filesystem::status(path, error);
  if (status.type() == std::filesystem::file_type::not_found) {
    ThrowInputError(path, "no such file; check the path");
  }
  if (std::filesystem::is_directory(status)) {
    ThrowInputError(path, "this is a folder; give a file");
  }
  if (!std::filesystem::is_regular_file(status)) {
    ThrowInputError(path, "this is not a regular file; give a file");
  }
  if (!std::ifstream(path, std::ios::binary)) {
    ThrowInputError(path, "the file cannot be opened; check its permissions");
  }
  if (std::filesystem::file_size(path, error) == 0) {
    ThrowInputError(path, "the file is empty; write it again");
  }
}

std::string NodeName(const MeshFile& mesh, Eigen::Index node) {
  if (mesh.node_numbers.empty()) {
    return "node " + std::to_string(node);
  }
  return "node " + std::to_string(node) + " (number " +
         std::to_string(mesh.node_numbers[node]) + " in Gmsh)";
}

void RequireNodePositions(const MeshFile& mesh) {
  if (mesh.num_nodes_left_out > 0) {
    ThrowInputError(
        mesh.path,
        "Gmsh leaves out " + std::to_string(mesh.num_nodes_left_out) +
            " nodes that no element uses, so that nodes cannot be told by "
            "their place in the file; save the mesh without these nodes "
            "(gmsh -save does)");
  }
}

}  // namespace elastimate
