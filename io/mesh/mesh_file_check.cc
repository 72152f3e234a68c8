#include "elastimate/io/mesh/mesh_file_check.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <numeric>
#include <optional>
#include <sstream>
#include <string>
#include <utility>
#include <vector>

#include "elastimate/io/text/input_error.h"

namespace elastimate {
namespace {

// Positions of single precision err by less than this share of the extent of a
// planar mesh, and of the length of an edge.
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
              " must lie in one plane z = const; rotate the mesh into such a "
              "plane, or mesh the volume if these are only its surface");
    }
  }
}

// Returns "0 and 1 (numbers 3 and 4 in Abaqus)", with numbers as far as there
// are some.
std::string ElementPair(const MeshFile& mesh, Eigen::Index first,
                        Eigen::Index second) {
  const auto pair = [](auto a, auto b) {
    return std::to_string(a) + " and " + std::to_string(b);
  };
  const std::string places = pair(first, second);
  if (mesh.element_numbers.empty()) {
    return places;
  }
  const std::string numbers =
      pair(mesh.element_numbers[first], mesh.element_numbers[second]);
  return places + (mesh.is_vtk ? " (of the cells " + numbers + ")"
                               : " (numbers " + numbers + " in " +
                                     ProgramOf(mesh) + ")");
}

void CheckElementsDiffer(const MeshFile& mesh) {
  const int num_vertices = mesh.Topology().num_vertices;
  const auto vertices = mesh.elements.topRows(num_vertices);
  // Elements are ordered by their smallest vertex, which few have in common.
  std::vector<Eigen::Index> end(mesh.nodes.cols() + 1, 0);
  for (Eigen::Index i = 0; i < vertices.cols(); ++i) {
    ++end[vertices.col(i).minCoeff() + 1];
  }
  std::partial_sum(end.begin(), end.end(), end.begin());
  std::vector<Eigen::Index> order(vertices.cols());
  for (Eigen::Index i = 0; i < vertices.cols(); ++i) {
    order[end[vertices.col(i).minCoeff()]++] = i;
  }
  // The elements of one smallest vertex: their vertices, ascending, and their
  // indices.
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
          mesh.Shapes() + " " +
              ElementPair(mesh, twin->second, (twin + 1)->second) +
              " have the same nodes; " +
              (mesh.is_vtk || !mesh.sets_of.empty()
                   ? "keep one of them"
                   : "save the mesh as .msh of version 4 (older ones "
                     "repeat what is in several physical groups)"));
    }
  }
}

// Calls visit(element, vertices in the element, node in the middle of them) for
// quadratic elements.
template <class Visitor>
void VisitMiddleNodes(const MeshFile& mesh, const Visitor& visit) {
  const ElementTopology& topology = mesh.Topology();
  for (Eigen::Index element = 0; element < mesh.elements.cols(); ++element) {
    for (Eigen::Index i = topology.num_vertices; i < topology.num_nodes; ++i) {
      visit(element, topology.middles[i - topology.num_vertices],
            mesh.elements(i, element));
    }
  }
}

void CheckMiddleNodes(const MeshFile& mesh) {
  std::vector<char> is_vertex(mesh.nodes.cols(), 0);
  for (const int node :
       mesh.elements.topRows(mesh.Topology().num_vertices).reshaped()) {
    is_vertex[node] = 1;
  }
  VisitMiddleNodes(mesh, [&](Eigen::Index element,
                             const std::vector<int>& vertices, int node) {
    if (is_vertex[node] != 0) {
      ThrowInputError(
          mesh.path,
          (vertices.size() == 2 ? "the mid-edge " : "the middle ") +
              NodeName(mesh, node) + " of " + ElementName(mesh, element) +
              " is a vertex of another one; mesh the specimen with elements "
              "that share whole edges");
    }
  });
}

// Puts nodes that are beside the middle of their vertices by rounding into the
// middle, or leaves all where they are and makes the elements curved.
void StraightenOrCurve(MeshFile& mesh) {
  // Positions of six digits err by less than this share of the length of an
  // edge.
  constexpr double kRounded = 1e-3;
  // Positions of single precision far from the origin may leave more.  A
  // position and the mean of others err by half a unit in the last place each,
  // 2^-24 of the largest coordinate, along three axes.
  constexpr double kMostRounded = 1e-2;
  const double of_single_precision =
      2 * std::sqrt(3.0) * std::ldexp(1.0, -24) *
      mesh.nodes(Eigen::all, mesh.elements.reshaped()).cwiseAbs().maxCoeff();
  std::map<int, Eigen::Vector3d> middles;
  std::optional<Eigen::Index> curved;
  VisitMiddleNodes(mesh, [&](Eigen::Index element,
                             const std::vector<int>& vertices, int node) {
    const Eigen::Vector3d first =
        mesh.nodes.col(mesh.elements(vertices[0], element));
    Eigen::Vector3d middle = Eigen::Vector3d::Zero();
    double length = 0;
    for (const int vertex : vertices) {
      const Eigen::Vector3d x = mesh.nodes.col(mesh.elements(vertex, element));
      middle += x / double(vertices.size());
      length = std::max(length, (x - first).norm());
    }
    const double distance = (mesh.nodes.col(node) - middle).norm();
    if (!curved && !(distance <= std::max(kRounded * length,
                                          std::min(kMostRounded * length,
                                                   of_single_precision)))) {
      curved = element;
    }
    if (distance > kSamePlace * length) {
      middles.emplace(node, middle);
    }
  });
  if (curved && !IsSimplex(mesh.kind)) {
    ThrowInputError(mesh.path,
                    ElementName(mesh, *curved) +
                        " is curved, which only tetrahedra and triangles may "
                        "be; mesh the specimen with straight edges (in Gmsh, "
                        "Mesh.SecondOrderLinear=1), or with " +
                        (mesh.Dimension() == 3 ? "tetrahedra" : "triangles"));
  }
  if (curved) {
    mesh.kind = CurvedKind(mesh.kind);
    return;
  }
  for (const auto& [node, middle] : middles) {
    mesh.moved.push_back({node, mesh.nodes.col(node)});
    mesh.nodes.col(node) = middle;
  }
}

}  // namespace

void CheckMeshFile(MeshFile& mesh) {
  CheckHasElements(mesh);
  MarkUsedNodes(mesh);
  CheckPositions(mesh);
  CheckPlane(mesh);
  CheckElementsDiffer(mesh);
  if (mesh.Topology().order == 2) {
    CheckMiddleNodes(mesh);
    StraightenOrCurve(mesh);
  }
}

}  // namespace elastimate
