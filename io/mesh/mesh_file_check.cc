#include "elastimate/io/mesh/mesh_file_check.h"

#include <algorithm>
#include <array>
#include <numeric>
#include <sstream>
#include <string>
#include <utility>
#include <vector>

#include "elastimate/io/text/input_error.h"

namespace elastimate {
namespace {

// Of the extent of a planar mesh, and of the length of an edge: what positions
// of single precision leave.
constexpr double kSamePlace = 1e-6;

void CheckHasElements(const MeshFile& mesh) {
  if (mesh.elements.cols() == 0) {
    ThrowInputError(mesh.path, std::string("the mesh has no elements; give one "
                                           "of ") +
                                   kSupportedElements);
  }
}

void MarkUsedNodes(MeshFile& mesh) {
  mesh.used.setConstant(mesh.nodes.cols(), false);
  for (const int node : mesh.elements.reshaped()) {
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

void CheckPlane(const MeshFile& mesh) {
  if (mesh.Dimension() == 3) {
    return;
  }
  const int first = mesh.elements(0, 0);
  Eigen::Array3d low = mesh.nodes.col(first).array();
  Eigen::Array3d high = low;
  for (const int node : mesh.elements.reshaped()) {
    low = low.min(mesh.nodes.col(node).array());
    high = high.max(mesh.nodes.col(node).array());
  }
  const double extent = (high - low).maxCoeff();
  for (Eigen::Index node = 0; node < mesh.nodes.cols(); ++node) {
    if (mesh.used[node] &&
        std::abs(mesh.nodes(2, node) - mesh.nodes(2, first)) >
            kSamePlace * extent) {
      std::ostringstream heights;
      heights << "z = " << mesh.nodes(2, node) << " and "
              << NodeName(mesh, first) << " at z = " << mesh.nodes(2, first);
      ThrowInputError(
          mesh.path,
          NodeName(mesh, node) + " is at " + heights.str() + ", but " +
              mesh.Shapes() +
              " must lie in one plane z = const; turn the mesh into it, or "
              "mesh the volume where these are only its surface");
    }
  }
}

void CheckElementsDiffer(const MeshFile& mesh) {
  const int num_vertices = mesh.Topology().num_vertices;
  const auto vertices = mesh.elements.topRows(num_vertices);
  // Ordered by the smallest vertex, which few have in common.
  std::vector<Eigen::Index> end(mesh.nodes.cols() + 1, 0);
  for (Eigen::Index i = 0; i < vertices.cols(); ++i) {
    ++end[vertices.col(i).minCoeff() + 1];
  }
  std::partial_sum(end.begin(), end.end(), end.begin());
  std::vector<Eigen::Index> order(vertices.cols());
  for (Eigen::Index i = 0; i < vertices.cols(); ++i) {
    order[end[vertices.col(i).minCoeff()]++] = i;
  }
  // The vertices of those of one smallest vertex, ascending, and their indices.
  std::vector<std::pair<std::array<int, 8>, Eigen::Index>> some;
  Eigen::Index first = 0;
  for (Eigen::Index node = 0; node < mesh.nodes.cols(); ++node) {
    some.clear();
    for (; first < end[node]; ++first) {
      auto& [sorted, element] = some.emplace_back();
      sorted.fill(-1);
      element = order[first];
      std::copy_n(vertices.col(element).data(), num_vertices, sorted.begin());
      std::sort(sorted.begin(), sorted.begin() + num_vertices);
    }
    std::sort(some.begin(), some.end());
    const auto twin = std::adjacent_find(
        some.begin(), some.end(),
        [](const auto& a, const auto& b) { return a.first == b.first; });
    if (twin != some.end()) {
      ThrowInputError(
          mesh.path,
          mesh.Shapes() + " " + std::to_string(twin->second) + " and " +
              std::to_string((twin + 1)->second) + " have the same nodes; " +
              (mesh.is_vtk ? "keep one of them"
                           : "save the mesh as .msh of version 4 (older ones "
                             "repeat what is in several physical groups)"));
    }
  }
}

void CheckMidEdgeNodes(const MeshFile& mesh) {
  const ElementTopology& topology = mesh.Topology();
  if (topology.order == 1) {
    return;
  }
  std::vector<char> is_vertex(mesh.nodes.cols(), 0);
  for (const int node :
       mesh.elements.topRows(topology.num_vertices).reshaped()) {
    is_vertex[node] = 1;
  }
  for (Eigen::Index element = 0; element < mesh.elements.cols(); ++element) {
    for (std::size_t i = 0; i < topology.edges.size(); ++i) {
      const int node = mesh.elements(
          topology.num_vertices + static_cast<Eigen::Index>(i), element);
      const int a = mesh.elements(topology.edges[i][0], element);
      const int b = mesh.elements(topology.edges[i][1], element);
      const auto what = [&] {
        return "the mid-edge " + NodeName(mesh, node) + " of " + mesh.Shape() +
               " " + std::to_string(element);
      };
      if (is_vertex[node] != 0) {
        ThrowInputError(mesh.path,
                        what() +
                            " is a vertex of another one; mesh the specimen "
                            "with elements that share whole edges");
      }
      const Eigen::Vector3d edge = mesh.nodes.col(b) - mesh.nodes.col(a);
      if (!((mesh.nodes.col(node) - mesh.nodes.col(a) - 0.5 * edge).norm() <=
            kSamePlace * edge.norm())) {
        ThrowInputError(
            mesh.path,
            what() + " is not in the middle between " + NodeName(mesh, a) +
                " and " + NodeName(mesh, b) +
                "; quadratic elements need straight edges here (in Gmsh "
                "Mesh.SecondOrderLinear = 1)");
      }
    }
  }
}

}  // namespace

void CheckMeshFile(MeshFile& mesh) {
  CheckHasElements(mesh);
  MarkUsedNodes(mesh);
  CheckPositions(mesh);
  CheckPlane(mesh);
  CheckElementsDiffer(mesh);
  CheckMidEdgeNodes(mesh);
}

}  // namespace elastimate
