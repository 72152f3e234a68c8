#include "elastimate/core/mesh/mesh.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <sstream>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include "elastimate/core/mesh/facets.h"
#include "elastimate/core/mesh/representable.h"
#include "elastimate/core/mesh/shape_functions.h"
#include "elastimate/core/mesh/tet4.h"

namespace elastimate {
namespace {

// Below this ratio of smallest height to longest edge an element is flat: far
// below any sliver worth computing with (a dihedral angle of 0.1 degrees has
// 1e-3), and above what single precision coordinates leave of a zero.
constexpr double kFlatHeight = 1e-6;

std::string ElementName(const Mesh& mesh, Eigen::Index element) {
  std::ostringstream name;
  name << mesh.Topology().shape << " " << element << " (nodes "
       << mesh.elements.col(element)
              .head(mesh.Topology().num_vertices)
              .transpose()
       << ")";
  return name.str();
}

// Tells whether the smallest height of the tetrahedron of these edges, 6 V over
// twice the largest face area, is below kFlatHeight of the longest edge.
bool IsFlat(const Eigen::Matrix3d& edges) {
  const auto e1 = edges.col(0);
  const auto e2 = edges.col(1);
  const auto e3 = edges.col(2);
  const Eigen::Vector3d c1 = e2.cross(e3);
  const double six_volumes = std::abs(e1.dot(c1));
  const double edge_square_at_node_0 =
      std::max({e1.squaredNorm(), e2.squaredNorm(), e3.squaredNorm()});
  // This is all that most elements need.  No edge is more than twice as long as
  // the longest at node 0, and twice an area is at most the square of an edge.
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

// Tells whether the triangle of these edges is flat in the same sense.
bool IsFlat(const Eigen::Matrix2d& edges) {
  const double longest_square =
      std::max({edges.col(0).squaredNorm(), edges.col(1).squaredNorm(),
                (edges.col(1) - edges.col(0)).squaredNorm()});
  return !(std::abs(edges.determinant()) > kFlatHeight * longest_square);
}

// Returns the edges from a vertex of an element.
template <int kDimension>
Eigen::Matrix<double, kDimension, kDimension> EdgesOfCorner(const Mesh& mesh,
                                                            const int* nodes,
                                                            const int* corner) {
  using Position = Eigen::Map<const Eigen::Matrix<double, kDimension, 1>>;
  const auto position = [&](int i) {
    return Position(mesh.nodes.data() +
                    kDimension * Eigen::Index(nodes[corner[i]]));
  };
  Eigen::Matrix<double, kDimension, kDimension> edges;
  for (int i = 0; i < kDimension; ++i) {
    edges.col(i) = position(i + 1) - position(0);
  }
  return edges;
}

// Tells whether the determinant of the map has the sign of `orientation` at all
// points of integration.
template <ElementKind kKind>
bool IsOriented(const Mesh& mesh, Eigen::Index element, double orientation) {
  const auto nodes = GatherMapNodes<kKind>(mesh, element);
  const auto& rule = IntegrationRule<kKind>();
  return std::all_of(rule.begin(), rule.end(), [&](const auto& at) {
    return (nodes * at.MapGradient().transpose()).determinant() * orientation >
           0;
  });
}

// Returns "flat", "folded" or "bent" for an element that is; else nothing.
template <int kDimension>
std::string_view WhyNoElement(const Mesh& mesh, const ElementTopology& topology,
                              Eigen::Index element) {
  const int* const nodes = mesh.elements.col(element).data();
  if (IsSimplex(mesh.kind)) {
    constexpr int kVertices[] = {0, 1, 2, 3};
    const auto edges = EdgesOfCorner<kDimension>(mesh, nodes, kVertices);
    if (IsFlat(edges)) {
      return "flat";
    }
    constexpr ElementKind kCurved =
        kDimension == 3 ? ElementKind::kCurvedTet10 : ElementKind::kCurvedTri6;
    return IsCurved(mesh.kind) &&
                   !IsOriented<kCurved>(mesh, element, edges.determinant())
               ? "bent"
               : "";
  }
  double orientation = 0;
  for (const std::vector<int>& corner : topology.corners) {
    const auto edges = EdgesOfCorner<kDimension>(mesh, nodes, corner.data());
    if (IsFlat(edges)) {
      return "flat";
    }
    const double determinant = edges.determinant();
    if (determinant * orientation < 0) {
      return "folded";
    }
    orientation = determinant;
  }
  const bool is_oriented =
      mesh.kind == ElementKind::kHex8
          ? IsOriented<ElementKind::kHex8>(mesh, element, orientation)
          : mesh.kind != ElementKind::kHex27 ||
                IsOriented<ElementKind::kHex27>(mesh, element, orientation);
  return is_oriented ? "" : "folded";
}

void ValidateSection(const Mesh& mesh) {
  const std::string kind(mesh.Topology().name);
  if (mesh.nodes.rows() != mesh.Dimension()) {
    throw std::invalid_argument("the nodes have " +
                                std::to_string(mesh.nodes.rows()) +
                                " coordinates, and elements of kind " + kind +
                                " need " + std::to_string(mesh.Dimension()));
  }
  if ((mesh.section.model == SectionModel::kSolid) != (mesh.Dimension() == 3)) {
    throw std::invalid_argument(
        mesh.Dimension() == 3
            ? "elements of kind " + kind +
                  " are solid; plane stress and plane strain are for planar "
                  "ones"
            : "elements of kind " + kind +
                  " are planar; give the model plane_stress or plane_strain");
  }
  if (!(mesh.section.thickness > 0) || !std::isfinite(mesh.section.thickness)) {
    throw std::invalid_argument(
        "the thickness of the section is not positive and finite; correct it");
  }
  RequireRepresentable(mesh.section.thickness, "the thickness of the section");
  if (mesh.Dimension() == 3 && mesh.section.thickness != 1) {
    throw std::invalid_argument(
        "a thickness is given for a mesh of three dimensions; leave it out");
  }
}

template <int kDimension>
void ValidateNodes(const Mesh& mesh) {
  if (mesh.NumNodes() == 0) {
    return;
  }
  using Position = Eigen::Array<double, kDimension, 1>;
  Position smallest = mesh.nodes.col(0);
  Position largest = smallest;
  for (Eigen::Index node = 0; node < mesh.NumNodes(); ++node) {
    const Position position =
        Eigen::Map<const Position>(mesh.nodes.data() + kDimension * node);
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
template <int kDimension>
std::vector<char> ValidateElements(const Mesh& mesh) {
  const ElementTopology& topology = mesh.Topology();
  if (mesh.elements.cols() == 0) {
    throw std::invalid_argument(
        "the mesh has no " + std::string(topology.shapes) +
        (kDimension == 3 ? "; mesh the volume, not only its surface"
                         : "; mesh the area, not only its rim"));
  }
  if (mesh.elements.rows() != topology.num_nodes) {
    throw std::invalid_argument(
        "the mesh has " + std::to_string(mesh.elements.rows()) +
        " nodes per element; those of kind " + std::string(topology.name) +
        " have " + std::to_string(topology.num_nodes));
  }
  // The flags are characters, which are faster to write than the bits of
  // vector<bool>.
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
    const std::string_view why_not =
        WhyNoElement<kDimension>(mesh, topology, element);
    if (why_not == "flat") {
      throw InvalidElement(
          element,
          ElementName(mesh, element) +
              " is flat (its smallest height is less than a millionth of its "
              "longest edge); remove it or mesh again");
    }
    if (why_not == "bent") {
      throw InvalidElement(
          element,
          ElementName(mesh, element) +
              " is bent so far that it folds onto itself (the determinant of "
              "its map changes sign); order its nodes as VTK does, or mesh "
              "again with smaller elements or straight edges");
    }
    if (!why_not.empty()) {
      throw InvalidElement(
          element,
          ElementName(mesh, element) +
              " is folded (its orientation changes between its vertices); "
              "order its nodes as VTK does, or mesh again");
    }
    for (Eigen::Index i = 0; i < mesh.elements.rows(); ++i) {
      used[nodes[i]] = 1;
    }
  }
  return used;
}

// Returns "0 and 1" or "0, 1, 2 and 3".
std::string NodeList(const std::vector<int>& nodes) {
  std::string list = std::to_string(nodes[0]);
  for (std::size_t i = 1; i < nodes.size(); ++i) {
    list += (i + 1 == nodes.size() ? " and " : ", ") + std::to_string(nodes[i]);
  }
  return list;
}

void ValidateMiddleNodes(const Mesh& mesh) {
  const Eigen::Index num_vertices = mesh.NumVertices();
  const ElementTopology& topology = mesh.Topology();
  std::vector<int> vertices;
  for (Eigen::Index element = 0; element < mesh.NumElements(); ++element) {
    for (int i = topology.num_vertices; i < topology.num_nodes; ++i) {
      const int node = mesh.elements(i, element);
      vertices.clear();
      for (const int vertex : topology.middles[i - topology.num_vertices]) {
        vertices.push_back(mesh.elements(vertex, element));
      }
      const auto name = [&] {
        return (vertices.size() == 2 ? "mid-edge node " : "middle node ") +
               std::to_string(node) + " of " + ElementName(mesh, element);
      };
      if (node < num_vertices) {
        throw std::invalid_argument(name() + " is numbered before vertex " +
                                    std::to_string(num_vertices - 1) +
                                    "; number all vertices first");
      }
      if (!IsCurved(mesh.kind) && !IsInTheMiddle(mesh, node, vertices)) {
        throw std::invalid_argument(
            name() + " is not in the middle between " + NodeList(vertices) +
            "; straighten the edges, and order the nodes as VTK does" +
            (IsSimplex(mesh.kind)
                 ? ", or make the elements of kind " +
                       std::string(TopologyOf(CurvedKind(mesh.kind)).name)
                 : ""));
      }
    }
  }
}

// Throws for hexahedra one of which is turned against the other: they share
// edges of a side but not the side, which is then on the surface twice.
void ValidateSidesOfHexahedra(const Mesh& mesh) {
  const Eigen::MatrixXi facets = BoundaryFacets(mesh);
  // Three of the four nodes of each facet, ascending, and the facet.
  std::vector<std::pair<std::array<int, 3>, Eigen::Index>> corners;
  corners.reserve(4 * facets.cols());
  for (Eigen::Index facet = 0; facet < facets.cols(); ++facet) {
    for (int left_out = 0; left_out < 4; ++left_out) {
      std::array<int, 3> three = {facets((left_out + 1) % 4, facet),
                                  facets((left_out + 2) % 4, facet),
                                  facets((left_out + 3) % 4, facet)};
      std::sort(three.begin(), three.end());
      corners.emplace_back(three, facet);
    }
  }
  std::sort(corners.begin(), corners.end());
  const auto twin = std::adjacent_find(
      corners.begin(), corners.end(),
      [](const auto& a, const auto& b) { return a.first == b.first; });
  if (twin != corners.end()) {
    std::ostringstream text;
    text << "the sides (" << facets.col(twin->second).head<4>().transpose()
         << ") and (" << facets.col((twin + 1)->second).head<4>().transpose()
         << ") of two hexahedra share three nodes, but not the fourth; order "
            "the nodes of each as VTK does";
    throw std::invalid_argument(text.str());
  }
}

// Validates the nodes and the elements, and returns whether an element uses
// each node.
template <int kDimension>
std::vector<char> ValidateOfDimension(const Mesh& mesh) {
  ValidateNodes<kDimension>(mesh);
  return ValidateElements<kDimension>(mesh);
}

}  // namespace

std::string_view SectionModelName(SectionModel model) {
  switch (model) {
    case SectionModel::kPlaneStrain:
      return "plane_strain";
    case SectionModel::kPlaneStress:
      return "plane_stress";
    case SectionModel::kSolid:
      break;
  }
  return "3d";
}

Eigen::Index Mesh::NumVertices() const {
  return Order() == 1
             ? NumNodes()
             : elements.topRows(Topology().num_vertices).maxCoeff() + 1;
}

void ValidateMesh(const Mesh& mesh) {
  ValidateSection(mesh);
  const std::vector<char> used = mesh.Dimension() == 3
                                     ? ValidateOfDimension<3>(mesh)
                                     : ValidateOfDimension<2>(mesh);
  if (mesh.Order() == 2) {
    ValidateMiddleNodes(mesh);
  }
  if (mesh.Dimension() == 3 && !IsSimplex(mesh.kind)) {
    ValidateSidesOfHexahedra(mesh);
  }
  const auto unused = std::find(used.begin(), used.end(), 0);
  if (unused != used.end()) {
    throw std::invalid_argument(
        "node " + std::to_string(unused - used.begin()) + " belongs to no " +
        std::string(mesh.Topology().shape) + "; remove it");
  }
  if (mesh.regions.size() != 0 && mesh.regions.size() != mesh.NumElements()) {
    throw std::invalid_argument(
        "there are " + std::to_string(mesh.regions.size()) +
        " region ids for " + std::to_string(mesh.NumElements()) + " " +
        std::string(mesh.Topology().shapes) + "; give one for each, or none");
  }
}

bool IsInTheMiddle(const Mesh& mesh, int node,
                   const std::vector<int>& vertices) {
  Eigen::VectorXd sum = Eigen::VectorXd::Zero(mesh.Dimension());
  double size = 0;
  for (const int vertex : vertices) {
    const auto x = mesh.nodes.col(vertex);
    sum += x;
    size = std::max(size, (x - mesh.nodes.col(vertices[0])).norm());
  }
  return (mesh.nodes.col(node) - sum / double(vertices.size())).norm() <=
         1e-6 * size;
}

Eigen::VectorXd ElementVolumes(const Mesh& mesh) {
  Eigen::VectorXd volumes = Eigen::VectorXd::Zero(mesh.NumElements());
  VisitElementKind(mesh.kind, [&](auto kind) {
    for (Eigen::Index e = 0; e < mesh.NumElements(); ++e) {
      VisitPoints<kind>(
          mesh, e, StiffnessRule<kind>(),
          [&](const auto& point, const auto&) { volumes(e) += point.volume; });
    }
  });
  return volumes;
}

Eigen::VectorXd ElementCentre(const Mesh& mesh, Eigen::Index element) {
  const auto vertices =
      mesh.elements.col(element).head(mesh.Topology().num_vertices);
  return mesh.nodes(Eigen::all, vertices).rowwise().mean();
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
