#include "elastimate/core/mesh/facets.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>
#include <set>
#include <tuple>
#include <vector>

#include "elastimate/core/mesh/shape_functions.h"

namespace elastimate {
namespace {

struct ElementFace {
  std::array<int, 4> sorted;  // Vertices; -1 where there are fewer.
  Eigen::Index element;
  int index;
};

// Returns the faces of all elements, those with the same vertices side by side.
std::vector<ElementFace> FacesOf(const Mesh& mesh) {
  const auto& of_element = mesh.Topology().faces;
  const auto visit = [&](const auto& visitor) {
    for (Eigen::Index element = 0; element < mesh.NumElements(); ++element) {
      for (std::size_t i = 0; i < of_element.size(); ++i) {
        ElementFace face = {{-1, -1, -1, -1}, element, static_cast<int>(i)};
        for (std::size_t k = 0; k < of_element[i].size(); ++k) {
          face.sorted[k] = mesh.elements(of_element[i][k], element);
        }
        std::sort(face.sorted.begin(), face.sorted.end());
        visitor(*std::find_if(face.sorted.begin(), face.sorted.end(),
                              [](int node) { return node >= 0; }),
                face);
      }
    }
  };
  // The faces of each lowest vertex, which are few, are sorted by themselves.
  std::vector<std::size_t> start(mesh.NumNodes() + 1, 0);
  visit([&](int lowest, const ElementFace&) { ++start[lowest + 1]; });
  std::partial_sum(start.begin(), start.end(), start.begin());
  std::vector<ElementFace> faces(start.back());
  std::vector<std::size_t> next(start.begin(), start.end() - 1);
  visit([&](int lowest, const ElementFace& face) {
    faces[next[lowest]++] = face;
  });
  for (Eigen::Index node = 0; node < mesh.NumNodes(); ++node) {
    std::sort(faces.begin() + std::ptrdiff_t(start[node]),
              faces.begin() + std::ptrdiff_t(start[node + 1]),
              [](const ElementFace& a, const ElementFace& b) {
                return std::tie(a.sorted, a.element) <
                       std::tie(b.sorted, b.element);
              });
  }
  return faces;
}

// Returns the faces that belong to one element only.
std::vector<ElementFace> OuterFaces(const Mesh& mesh) {
  const std::vector<ElementFace> faces = FacesOf(mesh);
  std::vector<ElementFace> outer;
  for (std::size_t i = 0; i < faces.size();) {
    std::size_t end = i + 1;
    while (end < faces.size() && faces[end].sorted == faces[i].sorted) {
      ++end;
    }
    if (end == i + 1) {
      outer.push_back(faces[i]);
    }
    i = end;
  }
  std::sort(outer.begin(), outer.end(),
            [](const ElementFace& a, const ElementFace& b) {
              return std::tie(a.element, a.index) <
                     std::tie(b.element, b.index);
            });
  return outer;
}

// Returns the nodes of a face of an element in the order of a facet, whose
// orientation is that of the topology.
Eigen::VectorXi NodesOfFace(const Mesh& mesh, Eigen::Index element,
                            const std::vector<int>& vertices) {
  const ElementTopology& topology = mesh.Topology();
  const int num_vertices = topology.NumVerticesOfFace();
  Eigen::VectorXi nodes(topology.NumNodesOfFace());
  for (int k = 0; k < num_vertices; ++k) {
    nodes(k) = mesh.elements(vertices[k], element);
  }
  for (int k = 0; num_vertices + k < nodes.size(); ++k) {
    std::vector<int> around;
    for (const int place : topology.middles_of_face[k]) {
      around.push_back(vertices[place]);
    }
    nodes(num_vertices + k) =
        mesh.elements(topology.MiddleNode(around), element);
  }
  return nodes;
}

// Returns the vertices of a facet in an order that does not depend on where
// around the facet they begin and in which direction they run.
std::vector<int> CircleOf(const Eigen::Ref<const Eigen::VectorXi>& facet,
                          int num_vertices) {
  std::vector<int> circle(facet.begin(), facet.end());
  const auto end = circle.begin() + num_vertices;
  std::rotate(circle.begin(), std::min_element(circle.begin(), end), end);
  if (circle[1] > *(end - 1)) {
    std::reverse(circle.begin() + 1, end);
  }
  std::sort(end, circle.end());
  return circle;
}

// Returns the determinant of the edges from the first corner.
double Orientation(const Mesh& mesh, Eigen::Index element) {
  const std::vector<int>& corner = mesh.Topology().corners[0];
  Eigen::MatrixXd edges(mesh.Dimension(), mesh.Dimension());
  for (int k = 0; k < mesh.Dimension(); ++k) {
    edges.col(k) = mesh.nodes.col(mesh.elements(corner[k + 1], element)) -
                   mesh.nodes.col(mesh.elements(corner[0], element));
  }
  return mesh.Dimension() == 3 ? Eigen::Matrix3d(edges).determinant()
                               : Eigen::Matrix2d(edges).determinant();
}

// Integrates over a facet that is no flat triangle, by the rule of an element
// of its shape.  The cross product of the tangents is the area vector.
template <ElementKind kFacet>
FacetWeights WeightsOfSurface(const Mesh& mesh,
                              const Eigen::Ref<const Eigen::VectorXi>& facet) {
  constexpr int kNodes = ElementSizes<kFacet>::kNodes;
  FacetWeights weights = {Eigen::VectorXd::Zero(kNodes),
                          Eigen::MatrixXd::Zero(3, kNodes)};
  const Eigen::Matrix<double, 3, kNodes> x = mesh.nodes(Eigen::all, facet);
  for (const auto& at : IntegrationRule<kFacet>()) {
    const Eigen::Matrix<double, 3, 2> tangents = x * at.gradient.transpose();
    const Eigen::Vector3d area_vector =
        at.weight * tangents.col(0).cross(tangents.col(1));
    weights.area += area_vector.norm() * at.value;
    weights.area_vector += area_vector * at.value.transpose();
  }
  return weights;
}

FacetWeights WeightsOfTriangle(const Mesh& mesh,
                               const Eigen::Ref<const Eigen::VectorXi>& facet) {
  const Eigen::Vector3d origin = mesh.nodes.col(facet(0));
  const Eigen::Vector3d e1 = mesh.nodes.col(facet(1)) - origin;
  const Eigen::Vector3d e2 = mesh.nodes.col(facet(2)) - origin;
  const Eigen::Vector3d area_vector = e1.cross(e2) / 2;
  // The vertices of a quadratic triangle get no share.
  Eigen::VectorXd share = Eigen::VectorXd::Zero(facet.size());
  share.tail<3>().setConstant(1.0 / 3);
  return {area_vector.norm() * share, area_vector * share.transpose()};
}

Eigen::Vector2d TurnedOutwards(const Eigen::Vector2d& tangent) {
  return {tangent.y(), -tangent.x()};
}

FacetWeights WeightsOfEdge(const Mesh& mesh,
                           const Eigen::Ref<const Eigen::VectorXi>& facet) {
  const Eigen::Vector2d edge =
      mesh.nodes.col(facet(1)) - mesh.nodes.col(facet(0));
  const Eigen::Vector2d area_vector =
      mesh.section.thickness * TurnedOutwards(edge);
  Eigen::VectorXd share(facet.size());
  if (facet.size() == 2) {
    share << 0.5, 0.5;
  } else {
    share << 1.0 / 6, 1.0 / 6, 4.0 / 6;
  }
  return {area_vector.norm() * share, area_vector * share.transpose()};
}

// Integrates by three Gauss points of the interval from -1 to 1, where the
// shape functions are t (t - 1) / 2, t (t + 1) / 2 and 1 - t^2.
FacetWeights WeightsOfCurvedEdge(
    const Mesh& mesh, const Eigen::Ref<const Eigen::VectorXi>& facet) {
  FacetWeights weights = {Eigen::VectorXd::Zero(3),
                          Eigen::MatrixXd::Zero(2, 3)};
  const Eigen::Matrix<double, 2, 3> x = mesh.nodes(Eigen::all, facet);
  const double outer = std::sqrt(0.6);
  for (const double t : {-outer, 0.0, outer}) {
    const Eigen::Vector3d value(t * (t - 1) / 2, t * (t + 1) / 2, 1 - t * t);
    const Eigen::Vector3d derivative(t - 0.5, t + 0.5, -2 * t);
    const Eigen::Vector2d area_vector = mesh.section.thickness *
                                        (t == 0 ? 8.0 : 5.0) / 9 *
                                        TurnedOutwards(x * derivative);
    weights.area += area_vector.norm() * value;
    weights.area_vector += area_vector * value.transpose();
  }
  return weights;
}

}  // namespace

Eigen::MatrixXi BoundaryFacets(const Mesh& mesh) {
  const ElementTopology& topology = mesh.Topology();
  const std::vector<ElementFace> outer = OuterFaces(mesh);
  const int num_vertices = topology.NumVerticesOfFace();
  Eigen::MatrixXi facets(topology.NumNodesOfFace(), outer.size());
  for (std::size_t i = 0; i < outer.size(); ++i) {
    const ElementFace& face = outer[i];
    std::vector<int> vertices = topology.faces[face.index];
    if (Orientation(mesh, face.element) < 0) {
      std::reverse(vertices.begin() + (num_vertices == 2 ? 0 : 1),
                   vertices.end());
    }
    facets.col(i) = NodesOfFace(mesh, face.element, vertices);
  }
  return facets;
}

Eigen::VectorXi ElementsOfFacets(const Mesh& mesh,
                                 const Eigen::MatrixXi& facets) {
  Eigen::VectorXi elements(facets.cols());
  int element = 0;
  const auto has = [&](int node) {
    return (mesh.elements.col(element).array() == node).any();
  };
  for (Eigen::Index i = 0; i < facets.cols(); ++i) {
    const auto facet = facets.col(i);
    while (!std::all_of(facet.begin(), facet.end(), has)) {
      ++element;
    }
    elements(i) = element;
  }
  return elements;
}

Eigen::MatrixXi BoundaryFacetsWhere(
    const Mesh& mesh, const std::function<bool(int)>& accepts_node) {
  const Eigen::MatrixXi all = BoundaryFacets(mesh);
  std::vector<Eigen::Index> accepted;
  for (Eigen::Index i = 0; i < all.cols(); ++i) {
    const auto facet = all.col(i);
    if (std::all_of(facet.begin(), facet.end(), accepts_node)) {
      accepted.push_back(i);
    }
  }
  return all(Eigen::all, accepted);
}

std::optional<Eigen::Index> FirstThatIsNoFace(const Mesh& mesh,
                                              const Eigen::MatrixXi& facets) {
  const ElementTopology& topology = mesh.Topology();
  const int num_vertices = topology.NumVerticesOfFace();
  std::set<std::vector<int>> missing;
  std::vector<char> is_in_facet(mesh.NumNodes(), 0);
  for (const auto& facet : facets.colwise()) {
    missing.insert(CircleOf(facet, num_vertices));
    for (const int node : facet) {
      is_in_facet[node] = 1;
    }
  }
  for (Eigen::Index element = 0; element < mesh.NumElements(); ++element) {
    int num_shared = 0;
    for (const int node : mesh.elements.col(element)) {
      num_shared += is_in_facet[node];
    }
    if (num_shared < num_vertices) {
      continue;
    }
    for (const std::vector<int>& vertices : topology.faces) {
      missing.erase(
          CircleOf(NodesOfFace(mesh, element, vertices), num_vertices));
    }
  }
  for (Eigen::Index facet = 0; facet < facets.cols(); ++facet) {
    if (missing.count(CircleOf(facets.col(facet), num_vertices)) != 0) {
      return facet;
    }
  }
  return std::nullopt;
}

FacetWeights WeightsOfFacet(const Mesh& mesh,
                            const Eigen::Ref<const Eigen::VectorXi>& facet) {
  switch (mesh.Topology().NumVerticesOfFace()) {
    case 2:
      return IsCurved(mesh.kind) ? WeightsOfCurvedEdge(mesh, facet)
                                 : WeightsOfEdge(mesh, facet);
    case 3:
      return IsCurved(mesh.kind)
                 ? WeightsOfSurface<ElementKind::kCurvedTri6>(mesh, facet)
                 : WeightsOfTriangle(mesh, facet);
    default:
      return mesh.Order() == 1
                 ? WeightsOfSurface<ElementKind::kQuad4>(mesh, facet)
                 : WeightsOfSurface<ElementKind::kQuad9>(mesh, facet);
  }
}

Eigen::MatrixXd UnitNormals(const Mesh& mesh, const Eigen::MatrixXi& facets) {
  Eigen::MatrixXd normals(mesh.Dimension(), facets.cols());
  for (Eigen::Index i = 0; i < facets.cols(); ++i) {
    normals.col(i) = WeightsOfFacet(mesh, facets.col(i))
                         .area_vector.rowwise()
                         .sum()
                         .normalized();
  }
  return normals;
}

double FacetArea(const Mesh& mesh, const Eigen::MatrixXi& facets) {
  double area = 0;
  for (Eigen::Index facet = 0; facet < facets.cols(); ++facet) {
    area += WeightsOfFacet(mesh, facets.col(facet)).area.sum();
  }
  return area;
}

ElementFacets FacetsOfElements(const Mesh& mesh) {
  const std::vector<ElementFace> faces = FacesOf(mesh);
  std::vector<const ElementFace*> firsts;
  std::vector<int> others;
  for (const ElementFace& face : faces) {
    if (!firsts.empty() && firsts.back()->sorted == face.sorted) {
      others.back() = static_cast<int>(face.element);
    } else {
      firsts.push_back(&face);
      others.push_back(-1);
    }
  }
  const Eigen::Index num_facets = Eigen::Index(firsts.size());
  ElementFacets facets = {Eigen::Matrix2Xi(2, num_facets),
                          Eigen::VectorXd(num_facets)};
  for (Eigen::Index i = 0; i < num_facets; ++i) {
    const ElementFace& face = *firsts[i];
    facets.elements.col(i) << static_cast<int>(face.element), others[i];
    facets.area(i) =
        WeightsOfFacet(mesh, NodesOfFace(mesh, face.element,
                                         mesh.Topology().faces[face.index]))
            .area.sum();
  }
  return facets;
}

}  // namespace elastimate
