#include "elastimate/core/mesh/linear_mesh.h"

#include <Eigen/LU>
#include <algorithm>
#include <array>
#include <limits>
#include <vector>

#include "elastimate/core/mesh/shape_functions.h"

namespace elastimate {
namespace {

// The places, in an element, of the nodes of each of its parts.
using Cuts = std::vector<std::vector<int>>;

// The tetrahedra at the vertices of a quadratic tetrahedron.
const Cuts kCornerCuts = {
    {0, 4, 6, 7}, {4, 1, 5, 8}, {6, 5, 2, 9}, {7, 8, 9, 3}};

// A diagonal of the octahedron of the mid-edge nodes, and the ring around it.
struct Diagonal {
  int a, b;
  std::array<int, 4> ring;
};
constexpr std::array<Diagonal, 3> kDiagonals = {
    {{4, 9, {5, 6, 7, 8}}, {5, 7, {4, 6, 9, 8}}, {6, 8, {4, 5, 9, 7}}}};

// The cuts of a triangle by its quadratic nodes, all with the orientation of
// the triangle.
const Cuts kTriangleCuts = {{0, 3, 5}, {3, 1, 4}, {5, 4, 2}, {3, 4, 5}};

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

Cuts CutTetrahedron(const Mesh& mesh, Eigen::Index element) {
  Cuts cuts = kCornerCuts;
  const Diagonal& diagonal = ShortestDiagonal(mesh, element);
  for (int i = 0; i < 4; ++i) {
    cuts.push_back(
        {diagonal.a, diagonal.b, diagonal.ring[i], diagonal.ring[(i + 1) % 4]});
  }
  return cuts;
}

// Cuts a quadrilateral or a hexahedron into parts of half its size with its
// orientation, one at each vertex.  Node k of the part at a vertex is half-way
// from the vertex to vertex k.
Cuts CutBlock(ElementKind kind) {
  const Eigen::MatrixXd nodes = ReferenceNodes(kind);
  const int num_vertices = TopologyOf(kind).num_vertices;
  Cuts cuts(num_vertices);
  for (int i = 0; i < num_vertices; ++i) {
    for (int k = 0; k < num_vertices; ++k) {
      const Eigen::VectorXd between = (nodes.col(i) + nodes.col(k)) / 2;
      int place = 0;
      while (nodes.col(place) != between) {
        ++place;
      }
      cuts[i].push_back(place);
    }
  }
  return cuts;
}

Cuts Cut(const Mesh& mesh, Eigen::Index element) {
  static const Cuts of_quadrilateral = CutBlock(ElementKind::kQuad9);
  static const Cuts of_hexahedron = CutBlock(ElementKind::kHex27);
  if (!IsSimplex(mesh.kind)) {
    return mesh.Dimension() == 2 ? of_quadrilateral : of_hexahedron;
  }
  return mesh.Dimension() == 2 ? kTriangleCuts : CutTetrahedron(mesh, element);
}

Cuts CutFacet(const Mesh& mesh) {
  if (mesh.Dimension() == 2) {
    return {{0, 2}, {2, 1}};
  }
  return IsSimplex(mesh.kind) ? kTriangleCuts : CutBlock(ElementKind::kQuad9);
}

// Returns the reference coordinates in a part of a point of its element.  The
// map between them is affine.  `nodes` are those of the part in its own
// reference coordinates, and `part` those in the coordinates of the element.
Eigen::VectorXd LocalIn(const std::vector<int>& corner,
                        const Eigen::MatrixXd& nodes,
                        const Eigen::MatrixXd& part,
                        const Eigen::VectorXd& local) {
  Eigen::MatrixXd edges(local.size(), local.size());
  Eigen::MatrixXd reference_edges(local.size(), local.size());
  for (Eigen::Index i = 0; i < local.size(); ++i) {
    edges.col(i) = part.col(corner[i + 1]) - part.col(corner[0]);
    reference_edges.col(i) = nodes.col(corner[i + 1]) - nodes.col(corner[0]);
  }
  return nodes.col(corner[0]) +
         reference_edges *
             edges.partialPivLu().solve(local - part.col(corner[0]));
}

// Returns how far a point is within the reference element, negative outside.
double Depth(ElementKind kind, const Eigen::VectorXd& local) {
  return IsSimplex(kind) ? std::min(local.minCoeff(), 1 - local.sum())
                         : 1 - local.cwiseAbs().maxCoeff();
}

// Returns the point of the reference element next to one that is outside by
// rounding.
Eigen::VectorXd Inside(ElementKind kind, const Eigen::VectorXd& local) {
  if (!IsSimplex(kind)) {
    return local.cwiseMax(-1).cwiseMin(1);
  }
  return local.cwiseMax(0) / std::max(1.0, local.cwiseMax(0).sum());
}

}  // namespace

LinearMesh::LinearMesh(const Mesh& mesh) : mesh_(mesh) {
  if (mesh.Order() == 1) {
    parts_ = mesh;
    return;
  }
  parts_.kind = LinearKind(mesh.kind);
  parts_.section = mesh.section;
  parts_.nodes = mesh.nodes;
  const auto num_cuts = Eigen::Index(Cut(mesh, 0).size());
  parts_.elements.resize(parts_.Topology().num_nodes,
                         num_cuts * mesh.NumElements());
  Eigen::Index part = 0;
  for (Eigen::Index element = 0; element < mesh.NumElements(); ++element) {
    for (const std::vector<int>& cut : Cut(mesh, element)) {
      parts_.elements.col(part++) = mesh.elements(cut, element);
    }
  }
  if (mesh.regions.size() != 0) {
    parts_.regions =
        mesh.regions.transpose().replicate(num_cuts, 1).reshaped().eval();
  }
}

Eigen::MatrixXi LinearMesh::FacetsOf(const Eigen::MatrixXi& facets) const {
  if (mesh_.Order() == 1) {
    return facets;
  }
  const Cuts cuts = CutFacet(mesh_);
  Eigen::MatrixXi parts(parts_.Topology().NumNodesOfFace(),
                        Eigen::Index(cuts.size()) * facets.cols());
  Eigen::Index part = 0;
  for (const auto& facet : facets.colwise()) {
    for (const std::vector<int>& cut : cuts) {
      parts.col(part++) = facet(cut);
    }
  }
  return parts;
}

MeshPoints LinearMesh::PointsOf(const MeshPoints& points) const {
  if (mesh_.Order() == 1) {
    return points;
  }
  const Eigen::MatrixXd reference = ReferenceNodes(mesh_.kind);
  const Eigen::MatrixXd of_part = ReferenceNodes(parts_.kind);
  const std::vector<int>& corner = parts_.Topology().corners[0];
  MeshPoints found = {Eigen::VectorXi(points.Size()),
                      Eigen::MatrixXd(mesh_.Dimension(), points.Size())};
  for (Eigen::Index i = 0; i < points.Size(); ++i) {
    const Cuts cuts = Cut(mesh_, points.elements(i));
    double deepest = -std::numeric_limits<double>::infinity();
    for (std::size_t k = 0; k < cuts.size(); ++k) {
      const Eigen::VectorXd local = LocalIn(
          corner, of_part, reference(Eigen::all, cuts[k]), points.local.col(i));
      if (Depth(parts_.kind, local) > deepest) {
        deepest = Depth(parts_.kind, local);
        found.elements(i) =
            static_cast<int>(cuts.size()) * points.elements(i) + int(k);
        found.local.col(i) = Inside(parts_.kind, local);
      }
    }
  }
  return found;
}

}  // namespace elastimate
