#include "elastimate/core/mesh/mesh.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <sstream>
#include <stdexcept>
#include <string>
#include <tuple>
#include <vector>

#include "elastimate/core/mesh/representable.h"
#include "elastimate/core/mesh/tet10.h"
#include "elastimate/core/mesh/tet4.h"

namespace elastimate {
namespace {

// Below this ratio of smallest height to longest edge a tetrahedron is flat:
// far below any sliver worth computing with (a dihedral angle of 0.1 degrees
// has 1e-3), and above what single precision coordinates leave of a zero.
constexpr double kFlatHeight = 1e-6;

// The faces of a tetrahedron of positive orientation, each counter-clockwise
// seen from outside; face i is opposite to node i.
constexpr int kFaces[4][3] = {{1, 2, 3}, {0, 3, 2}, {0, 1, 3}, {0, 2, 1}};

std::string ElementName(const Mesh& mesh, Eigen::Index element) {
  std::ostringstream name;
  name << "tetrahedron " << element << " (nodes "
       << mesh.elements.col(element).head<4>().transpose() << ")";
  return name.str();
}

// Whether the smallest height, 6 V over twice the largest face area, is below
// kFlatHeight of the longest edge.
bool IsFlat(const TetrahedronNodes& x) {
  const Eigen::Vector3d e1 = x.col(1) - x.col(0);
  const Eigen::Vector3d e2 = x.col(2) - x.col(0);
  const Eigen::Vector3d e3 = x.col(3) - x.col(0);
  const Eigen::Vector3d c1 = e2.cross(e3);
  const double six_volumes = std::abs(e1.dot(c1));
  const double edge_square_at_node_0 =
      std::max({e1.squaredNorm(), e2.squaredNorm(), e3.squaredNorm()});
  // All that most elements need: no edge is more than twice as long as the
  // longest at node 0, and twice an area at most the square of an edge.
  if (six_volumes * six_volumes >
      64 * kFlatHeight * kFlatHeight * edge_square_at_node_0 *
          edge_square_at_node_0 * edge_square_at_node_0) {
    return false;
  }
  const double largest_edge_square =
      std::max({edge_square_at_node_0, (e2 - e1).squaredNorm(),
                (e3 - e2).squaredNorm(), (e1 - e3).squaredNorm()});
  const Eigen::Vector3d c2 = e3.cross(e1);
  const Eigen::Vector3d c3 = e1.cross(e2);
  const double largest_area_square =
      std::max({c1.squaredNorm(), c2.squaredNorm(), c3.squaredNorm(),
                (c1 + c2 + c3).squaredNorm()});
  // Squares cost less than roots, but may underflow.
  return !(six_volumes * six_volumes > kFlatHeight * kFlatHeight *
                                           largest_edge_square *
                                           largest_area_square) &&
         !(six_volumes > kFlatHeight * std::sqrt(largest_edge_square) *
                             std::sqrt(largest_area_square));
}

void ValidateNodes(const Mesh& mesh) {
  if (mesh.NumNodes() == 0) {
    return;
  }
  Eigen::Array3d smallest = mesh.nodes.col(0);
  Eigen::Array3d largest = smallest;
  for (Eigen::Index node = 0; node < mesh.NumNodes(); ++node) {
    const Eigen::Array3d position = mesh.nodes.col(node);
    if (!position.allFinite()) {
      throw std::invalid_argument(
          "node " + std::to_string(node) +
          " has a position that is not finite; correct the mesh");
    }
    smallest = smallest.min(position);
    largest = largest.max(position);
  }
  RequireRepresentable((largest - smallest).maxCoeff(),
                       "the extent of the mesh");
}

// Returns, for each node, whether an element uses it.
std::vector<char> ValidateElements(const Mesh& mesh) {
  if (mesh.elements.cols() == 0) {
    throw std::invalid_argument(
        "the mesh has no tetrahedra; mesh the volume, not only its surface");
  }
  if (mesh.elements.rows() != 4 && mesh.elements.rows() != 10) {
    throw std::invalid_argument(
        "the mesh has " + std::to_string(mesh.elements.rows()) +
        " nodes per element; linear tetrahedra have 4, quadratic ones 10");
  }
  // Of characters, which are faster to write than bits.
  std::vector<char> used(mesh.NumNodes(), 0);
  for (Eigen::Index element = 0; element < mesh.NumElements(); ++element) {
    const int* const nodes = mesh.elements.col(element).data();
    if (std::any_of(nodes, nodes + mesh.elements.rows(), [&](int node) {
          return node < 0 || node >= mesh.NumNodes();
        })) {
      throw std::invalid_argument(
          ElementName(mesh, element) + " has a node index outside 0.." +
          std::to_string(mesh.NumNodes() - 1) + "; correct the mesh");
    }
    if (IsFlat(GatherTetrahedron(mesh, element))) {
      throw std::invalid_argument(
          ElementName(mesh, element) +
          " is flat (its smallest height is less than a millionth of its "
          "longest edge); remove it or mesh again");
    }
    for (Eigen::Index i = 0; i < mesh.elements.rows(); ++i) {
      used[nodes[i]] = 1;
    }
  }
  return used;
}

void ValidateMidEdgeNodes(const Mesh& mesh) {
  const Eigen::Index num_vertices = mesh.NumVertices();
  for (Eigen::Index element = 0; element < mesh.NumElements(); ++element) {
    for (int i = 0; i < 6; ++i) {
      const int node = mesh.elements(4 + i, element);
      const int a = mesh.elements(kTetrahedronEdges[i][0], element);
      const int b = mesh.elements(kTetrahedronEdges[i][1], element);
      if (node < num_vertices) {
        throw std::invalid_argument(
            "mid-edge node " + std::to_string(node) + " of " +
            ElementName(mesh, element) + " is numbered before vertex " +
            std::to_string(num_vertices - 1) + "; number all vertices first");
      }
      if (!IsInTheMiddle(mesh, node, a, b)) {
        throw std::invalid_argument(
            "mid-edge node " + std::to_string(node) + " of " +
            ElementName(mesh, element) + " is not in the middle between " +
            std::to_string(a) + " and " + std::to_string(b) +
            "; straighten the edges, and order the nodes as VTK does");
      }
    }
  }
}

}  // namespace

void ValidateMesh(const Mesh& mesh) {
  ValidateNodes(mesh);
  const std::vector<char> used = ValidateElements(mesh);
  if (mesh.Order() == 2) {
    ValidateMidEdgeNodes(mesh);
  }
  const auto unused = std::find(used.begin(), used.end(), 0);
  if (unused != used.end()) {
    throw std::invalid_argument("node " +
                                std::to_string(unused - used.begin()) +
                                " belongs to no tetrahedron; remove it");
  }
  if (mesh.regions.size() != 0 && mesh.regions.size() != mesh.NumElements()) {
    throw std::invalid_argument(
        "there are " + std::to_string(mesh.regions.size()) +
        " region ids for " + std::to_string(mesh.NumElements()) +
        " tetrahedra; give one for each, or none");
  }
}

Eigen::MatrixXi BoundaryFacets(const Mesh& mesh) {
  struct Face {
    std::array<int, 3> sorted;
    Eigen::Index element;
    int index;
  };
  std::vector<Face> faces;
  faces.reserve(4 * mesh.NumElements());
  for (Eigen::Index element = 0; element < mesh.NumElements(); ++element) {
    for (int i = 0; i < 4; ++i) {
      std::array<int, 3> nodes;
      for (int k = 0; k < 3; ++k) {
        nodes[k] = mesh.elements(kFaces[i][k], element);
      }
      std::sort(nodes.begin(), nodes.end());
      faces.push_back({nodes, element, i});
    }
  }
  std::sort(faces.begin(), faces.end(), [](const Face& a, const Face& b) {
    return std::tie(a.sorted, a.element) < std::tie(b.sorted, b.element);
  });

  std::vector<Face> boundary;
  for (std::size_t i = 0; i < faces.size();) {
    std::size_t end = i + 1;
    while (end < faces.size() && faces[end].sorted == faces[i].sorted) {
      ++end;
    }
    if (end == i + 1) {
      boundary.push_back(faces[i]);
    }
    i = end;
  }
  std::sort(boundary.begin(), boundary.end(), [](const Face& a, const Face& b) {
    return std::tie(a.element, a.index) < std::tie(b.element, b.index);
  });

  Eigen::MatrixXi facets(mesh.Order() == 2 ? 6 : 3, boundary.size());
  for (std::size_t i = 0; i < boundary.size(); ++i) {
    const Face& face = boundary[i];
    std::array<int, 3> vertices = {kFaces[face.index][0], kFaces[face.index][1],
                                   kFaces[face.index][2]};
    if (SignedTetrahedronVolume(GatherTetrahedron(mesh, face.element)) < 0) {
      std::swap(vertices[1], vertices[2]);
    }
    for (int k = 0; k < 3; ++k) {
      facets(k, i) = mesh.elements(vertices[k], face.element);
    }
    for (int k = 3; k < facets.rows(); ++k) {
      const auto& [a, b] = kTriangleEdges[k - 3];
      facets(k, i) =
          mesh.elements(kMidEdgeNodes[vertices[a]][vertices[b]], face.element);
    }
  }
  return facets;
}

Eigen::VectorXd SmallestDihedralAngles(const Mesh& mesh) {
  Eigen::VectorXd smallest(mesh.NumElements());
  for (Eigen::Index element = 0; element < mesh.NumElements(); ++element) {
    const TetrahedronGradients gradients(GatherTetrahedron(mesh, element));
    // Shape function gradients are the inward face normals.
    const Eigen::Matrix<double, 3, 4> normals =
        gradients.gradient.colwise().normalized();
    double largest_cosine = -1;
    for (int i = 0; i < 4; ++i) {
      for (int j = 0; j < i; ++j) {
        largest_cosine =
            std::max(largest_cosine, -normals.col(i).dot(normals.col(j)));
      }
    }
    smallest(element) = std::acos(std::min(largest_cosine, 1.0));
  }
  return smallest;
}

}  // namespace elastimate
