#include "elastimate/core/mesh/simplicial_mesh.h"

#include <Eigen/LU>
#include <algorithm>
#include <array>
#include <limits>
#include <utility>
#include <vector>

#include "elastimate/core/mesh/shape_functions.h"

namespace elastimate {
namespace {

// The nodes of each simplex; a triangle uses the first three.
using Simplices = std::vector<std::array<int, 4>>;
using Triangle = std::array<int, 3>;

// The tetrahedra at the vertices, by the nodes of the quadratic tetrahedron.
constexpr std::array<std::array<int, 4>, 4> kCornerCuts = {
    {{0, 4, 6, 7}, {4, 1, 5, 8}, {6, 5, 2, 9}, {7, 8, 9, 3}}};

// A diagonal of the octahedron of the mid-edge nodes, and the ring around it.
struct Diagonal {
  int a, b;
  std::array<int, 4> ring;
};
constexpr std::array<Diagonal, 3> kDiagonals = {
    {{4, 9, {5, 6, 7, 8}}, {5, 7, {4, 6, 9, 8}}, {6, 8, {4, 5, 9, 7}}}};

// The cuts of a triangle by its quadratic nodes, all with the orientation of
// the triangle.
constexpr std::array<Triangle, 4> kTriangleCuts = {
    {{0, 3, 5}, {3, 1, 4}, {5, 4, 2}, {3, 4, 5}}};

const Diagonal& ShortestDiagonal(const Mesh& mesh, Eigen::Index element) {
  const auto length = [&](const Diagonal& diagonal) {
    return (mesh.nodes.col(mesh.elements(diagonal.a, element)) -
            mesh.nodes.col(mesh.elements(diagonal.b, element)))
        .norm();
  };
  return *std::min_element(kDiagonals.begin(), kDiagonals.end(),
                           [&](const Diagonal& one, const Diagonal& other) {
                             return length(one) < length(other);
                           });
}

Simplices CutQuadraticTetrahedron(const Mesh& mesh, Eigen::Index element) {
  Simplices cuts(kCornerCuts.begin(), kCornerCuts.end());
  const Diagonal& diagonal = ShortestDiagonal(mesh, element);
  for (int i = 0; i < 4; ++i) {
    cuts.push_back(
        {diagonal.a, diagonal.b, diagonal.ring[i], diagonal.ring[(i + 1) % 4]});
  }
  for (std::array<int, 4>& cut : cuts) {
    for (int& node : cut) {
      node = mesh.elements(node, element);
    }
  }
  return cuts;
}

// Returns the place of each node in an order in which the nodes of one colour
// come before those of the other.  Neighbours along edges have different
// colours, as far as there is such a colouring.
Eigen::VectorXi RankByColour(const Mesh& mesh) {
  const auto num_nodes = static_cast<int>(mesh.NumNodes());
  std::vector<std::vector<int>> neighbours(num_nodes);
  for (Eigen::Index e = 0; e < mesh.NumElements(); ++e) {
    for (const auto& [i, j] : mesh.Topology().edges) {
      const int a = mesh.elements(i, e);
      const int b = mesh.elements(j, e);
      neighbours[a].push_back(b);
      neighbours[b].push_back(a);
    }
  }
  constexpr int kNone = -1;
  Eigen::VectorXi rank = Eigen::VectorXi::Constant(num_nodes, kNone);
  std::vector<int> front;
  for (int seed = 0; seed < num_nodes; ++seed) {
    if (rank(seed) != kNone) {
      continue;
    }
    rank(seed) = seed;
    front = {seed};
    while (!front.empty()) {
      std::vector<int> next;
      for (const int node : front) {
        for (const int neighbour : neighbours[node]) {
          if (rank(neighbour) == kNone) {
            rank(neighbour) =
                neighbour + (rank(node) < num_nodes ? num_nodes : 0);
            next.push_back(neighbour);
          }
        }
      }
      front = std::move(next);
    }
  }
  return rank;
}

// Cuts along the diagonal from the node of the first rank, and keeps the
// orientation.
std::array<Triangle, 2> CutQuadrilateral(const std::array<int, 4>& nodes,
                                         const Eigen::VectorXi& rank) {
  const auto first =
      std::min_element(nodes.begin(), nodes.end(),
                       [&](int a, int b) { return rank(a) < rank(b); });
  const auto node = [&](int i) {
    return nodes[(first - nodes.begin() + i) % 4];
  };
  return {{{node(0), node(1), node(2)}, {node(0), node(2), node(3)}}};
}

// Joins the node of the first rank to the triangles of the faces that do not
// have it.
Simplices CutHexahedron(const Mesh& mesh, Eigen::Index element,
                        const Eigen::VectorXi& rank) {
  const auto nodes = mesh.elements.col(element);
  const int first =
      *std::min_element(nodes.begin(), nodes.end(),
                        [&](int a, int b) { return rank(a) < rank(b); });
  Simplices cuts;
  for (const std::vector<int>& face : mesh.Topology().faces) {
    const std::array<int, 4> corners = {nodes(face[0]), nodes(face[1]),
                                        nodes(face[2]), nodes(face[3])};
    if (std::find(corners.begin(), corners.end(), first) == corners.end()) {
      for (const auto& [a, b, c] : CutQuadrilateral(corners, rank)) {
        cuts.push_back({a, b, c, first});
      }
    }
  }
  return cuts;
}

Simplices Cut(const Mesh& mesh, Eigen::Index element,
              const Eigen::VectorXi& rank) {
  const auto nodes = mesh.elements.col(element);
  Simplices cuts;
  switch (mesh.kind) {
    case ElementKind::kTet4:
      return {{nodes(0), nodes(1), nodes(2), nodes(3)}};
    case ElementKind::kTri3:
      return {{nodes(0), nodes(1), nodes(2)}};
    case ElementKind::kTet10:
    case ElementKind::kCurvedTet10:
      return CutQuadraticTetrahedron(mesh, element);
    case ElementKind::kHex8:
      return CutHexahedron(mesh, element, rank);
    case ElementKind::kTri6:
    case ElementKind::kCurvedTri6:
      for (const auto& [a, b, c] : kTriangleCuts) {
        cuts.push_back({nodes(a), nodes(b), nodes(c)});
      }
      return cuts;
    case ElementKind::kQuad4:
      break;
  }
  for (const auto& [a, b, c] :
       CutQuadrilateral({nodes(0), nodes(1), nodes(2), nodes(3)}, rank)) {
    cuts.push_back({a, b, c});
  }
  return cuts;
}

// Cuts a facet of a kind whose facets are no simplices of the vertices alone.
// A cut of an edge is the first two nodes of a Triangle.
std::vector<Triangle> CutFacet(const Mesh& mesh,
                               const Eigen::Ref<const Eigen::VectorXi>& nodes,
                               const Eigen::VectorXi& rank) {
  if (mesh.Dimension() == 2) {
    return {{nodes(0), nodes(2)}, {nodes(2), nodes(1)}};
  }
  std::vector<Triangle> cuts;
  if (IsSimplex(mesh.kind)) {
    for (const auto& [a, b, c] : kTriangleCuts) {
      cuts.push_back({nodes(a), nodes(b), nodes(c)});
    }
    return cuts;
  }
  for (const Triangle& cut :
       CutQuadrilateral({nodes(0), nodes(1), nodes(2), nodes(3)}, rank)) {
    cuts.push_back(cut);
  }
  return cuts;
}

// Returns the reference coordinates of a point in the simplex of these
// vertices.
Eigen::VectorXd LocalIn(const Eigen::MatrixXd& vertices,
                        const Eigen::VectorXd& position) {
  const Eigen::MatrixXd edges =
      vertices.rightCols(position.size()).colwise() - vertices.col(0);
  return edges.partialPivLu().solve(position - vertices.col(0));
}

// Returns the vertices of a cut of an element.  They are reference coordinates
// of the element where that is a simplex, so that a point of a curved one stays
// in place; else they are positions.
Eigen::MatrixXd VerticesOfCut(const Mesh& mesh, Eigen::Index element,
                              const Eigen::Ref<const Eigen::VectorXi>& cut) {
  if (!IsSimplex(mesh.kind)) {
    return mesh.nodes(Eigen::all, cut);
  }
  const Eigen::MatrixXd reference = ReferenceNodes(mesh.kind);
  const auto nodes = mesh.elements.col(element);
  Eigen::MatrixXd vertices(reference.rows(), cut.size());
  for (Eigen::Index i = 0; i < cut.size(); ++i) {
    vertices.col(i) = reference.col(
        std::find(nodes.begin(), nodes.end(), cut(i)) - nodes.begin());
  }
  return vertices;
}

// Returns how far a point is within the reference simplex, negative outside.
double Depth(const Eigen::VectorXd& local) {
  return std::min(local.minCoeff(), 1 - local.sum());
}

}  // namespace

SimplicialMesh::SimplicialMesh(const Mesh& mesh) : mesh_(mesh) {
  if (!IsSimplex(mesh.kind)) {
    rank_ = RankByColour(mesh);
  }
  simplices_.kind =
      mesh.Dimension() == 3 ? ElementKind::kTet4 : ElementKind::kTri3;
  simplices_.section = mesh.section;
  simplices_.nodes = mesh.nodes;
  const int num_nodes = simplices_.Topology().num_nodes;
  const auto num_cuts = Eigen::Index(Cut(mesh, 0, rank_).size());
  simplices_.elements.resize(num_nodes, num_cuts * mesh.NumElements());
  Eigen::Index simplex = 0;
  for (Eigen::Index element = 0; element < mesh.NumElements(); ++element) {
    for (const std::array<int, 4>& cut : Cut(mesh, element, rank_)) {
      simplices_.elements.col(simplex++) =
          Eigen::Map<const Eigen::VectorXi>(cut.data(), num_nodes);
    }
  }
  if (mesh.regions.size() != 0) {
    simplices_.regions =
        mesh.regions.transpose().replicate(num_cuts, 1).reshaped().eval();
  }
}

Eigen::MatrixXi SimplicialMesh::FacetsOf(const Eigen::MatrixXi& facets) const {
  const int dimension = mesh_.Dimension();
  if (facets.rows() == dimension || facets.cols() == 0) {
    return facets;
  }
  const auto num_cuts =
      Eigen::Index(CutFacet(mesh_, facets.col(0), rank_).size());
  Eigen::MatrixXi cuts(dimension, num_cuts * facets.cols());
  for (Eigen::Index i = 0; i < facets.cols(); ++i) {
    const std::vector<Triangle> of_facet =
        CutFacet(mesh_, facets.col(i), rank_);
    for (Eigen::Index k = 0; k < num_cuts; ++k) {
      cuts.col(num_cuts * i + k) =
          Eigen::Map<const Eigen::VectorXi>(of_facet[k].data(), dimension);
    }
  }
  return cuts;
}

MeshPoints SimplicialMesh::PointsOf(const MeshPoints& points) const {
  const Eigen::Index num_cuts = simplices_.NumElements() / mesh_.NumElements();
  if (num_cuts == 1) {
    return points;
  }
  const Eigen::MatrixXd positions =
      IsSimplex(mesh_.kind) ? points.local
                            : Interpolate(mesh_, points, mesh_.nodes);
  MeshPoints found = {Eigen::VectorXi(points.Size()),
                      Eigen::MatrixXd(mesh_.Dimension(), points.Size())};
  for (Eigen::Index i = 0; i < points.Size(); ++i) {
    double deepest = -std::numeric_limits<double>::infinity();
    for (Eigen::Index k = 0; k < num_cuts; ++k) {
      const Eigen::Index simplex = num_cuts * points.elements(i) + k;
      const Eigen::VectorXd local =
          LocalIn(VerticesOfCut(mesh_, points.elements(i),
                                simplices_.elements.col(simplex)),
                  positions.col(i));
      if (Depth(local) > deepest) {
        deepest = Depth(local);
        found.elements(i) = static_cast<int>(simplex);
        found.local.col(i) =
            local.cwiseMax(0) / std::max(1.0, local.cwiseMax(0).sum());
      }
    }
  }
  return found;
}

}  // namespace elastimate
