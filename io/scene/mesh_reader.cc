#include "elastimate/io/scene/mesh_reader.h"

#include <algorithm>
#include <array>
#include <numeric>
#include <set>
#include <utility>
#include <vector>

#include "elastimate/io/gmsh/gmsh_mesh.h"
#include "elastimate/io/text/input_error.h"
#include "elastimate/io/vtk/vtk_mesh.h"

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

}  // namespace elastimate
