#include "elastimate/core/scene/quadratic_scene.h"

#include <algorithm>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include "elastimate/core/mesh/node_graph.h"
#include "elastimate/core/mesh/tet10.h"

namespace elastimate {
namespace {

// The edges of a linear mesh: the pairs of different nodes of its graph, in
// the same order.
class Edges {
 public:
  explicit Edges(const Mesh& mesh) : graph_(mesh) {
    ends_.resize(2, graph_.NumPairs() - mesh.NumNodes());
    for (int low = 0; low < mesh.NumNodes(); ++low) {
      for (Eigen::Index pair = graph_.start[low] + 1;
           pair < graph_.start[low + 1]; ++pair) {
        ends_.col(Index(low, pair)) << low, graph_.row[pair];
      }
    }
  }

  Eigen::Index Size() const { return ends_.cols(); }
  /// 2 x num_edges nodes, the lower one first.
  const Eigen::Matrix2Xi& Ends() const { return ends_; }

  /// The edge between two nodes; -1 when there is none.
  Eigen::Index Find(int a, int b) const {
    const auto [low, high] = std::minmax(a, b);
    const auto first = graph_.row.begin() + graph_.start[low];
    const auto last = graph_.row.begin() + graph_.start[low + 1];
    const auto found = std::lower_bound(first, last, high);
    return low == high || found == last || *found != high
               ? -1
               : Index(low, found - graph_.row.begin());
  }

 private:
  // Each column up to that of `low` begins with a pair that is no edge.
  static Eigen::Index Index(int low, Eigen::Index pair) {
    return pair - low - 1;
  }

  NodeGraph graph_;
  Eigen::Matrix2Xi ends_;
};

// `values` with columns for the mid-edge nodes.
template <typename Array>
Array WithMidEdges(const Array& values, const Array& mid_edges) {
  Array all(values.rows(), values.cols() + mid_edges.cols());
  all << values, mid_edges;
  return all;
}

Eigen::Matrix3Xd MeanOfEnds(const Eigen::Matrix3Xd& values,
                            const Edges& edges) {
  return 0.5 * (values(Eigen::all, edges.Ends().row(0)) +
                values(Eigen::all, edges.Ends().row(1)));
}

Mesh WithMidEdgeNodes(const Mesh& mesh, const Edges& edges) {
  Mesh quadratic;
  quadratic.regions = mesh.regions;
  quadratic.nodes = WithMidEdges(mesh.nodes, MeanOfEnds(mesh.nodes, edges));
  quadratic.elements.resize(10, mesh.NumElements());
  quadratic.elements.topRows<4>() = mesh.elements;
  for (Eigen::Index e = 0; e < mesh.NumElements(); ++e) {
    for (int i = 0; i < 6; ++i) {
      quadratic.elements(4 + i, e) = static_cast<int>(
          mesh.NumNodes() +
          edges.Find(mesh.elements(kTetrahedronEdges[i][0], e),
                     mesh.elements(kTetrahedronEdges[i][1], e)));
    }
  }
  return quadratic;
}

// Which edges cross the interior from one node of the surface to another.
std::vector<bool> CrossingEdges(const Mesh& mesh, const Edges& edges) {
  std::vector<bool> node_on_surface(mesh.NumNodes(), false);
  std::vector<bool> edge_on_surface(edges.Size(), false);
  const Eigen::MatrixXi facets = BoundaryFacets(mesh);
  for (Eigen::Index facet = 0; facet < facets.cols(); ++facet) {
    for (const auto& [a, b] : kTriangleEdges) {
      node_on_surface[facets(a, facet)] = true;
      edge_on_surface[edges.Find(facets(a, facet), facets(b, facet))] = true;
    }
  }
  std::vector<bool> crossing(edges.Size());
  for (Eigen::Index edge = 0; edge < edges.Size(); ++edge) {
    crossing[edge] = !edge_on_surface[edge] &&
                     node_on_surface[edges.Ends()(0, edge)] &&
                     node_on_surface[edges.Ends()(1, edge)];
  }
  return crossing;
}

Supports WithMidEdgeSupports(const Supports& supports, const Mesh& mesh,
                             const Edges& edges) {
  const std::vector<bool> crossing = CrossingEdges(mesh, edges);
  ComponentMask held = supports.held(Eigen::all, edges.Ends().row(0)) &&
                       supports.held(Eigen::all, edges.Ends().row(1));
  for (Eigen::Index edge = 0; edge < edges.Size(); ++edge) {
    if (crossing[edge]) {
      held.col(edge).setConstant(false);
    }
  }
  return {WithMidEdges(supports.held, held),
          WithMidEdges(supports.displacement,
                       MeanOfEnds(supports.displacement, edges))};
}

Eigen::MatrixXi WithMidEdgeNodes(const Eigen::MatrixXi& facets,
                                 const Mesh& mesh, const Edges& edges) {
  Eigen::MatrixXi quadratic(6, facets.cols());
  quadratic.topRows<3>() = facets;
  for (Eigen::Index facet = 0; facet < facets.cols(); ++facet) {
    for (int i = 0; i < 3; ++i) {
      const Eigen::Index edge = edges.Find(facets(kTriangleEdges[i][0], facet),
                                           facets(kTriangleEdges[i][1], facet));
      if (edge < 0) {
        throw std::invalid_argument(
            "facet " + std::to_string(facet) +
            " of a load is no face of a tetrahedron; take the "
            "facets from the mesh");
      }
      quadratic(3 + i, facet) = static_cast<int>(mesh.NumNodes() + edge);
    }
  }
  return quadratic;
}

// One overload per kind of load.
struct LoadConverter {
  const Mesh& mesh;
  const Edges& edges;

  Load operator()(const NodalForces& load) const {
    const Eigen::Matrix3Xd none = Eigen::Matrix3Xd::Zero(3, edges.Size());
    return NodalForces{WithMidEdges(load.force, none)};
  }
  Load operator()(const BodyForce& load) const { return load; }
  Load operator()(const Traction& load) const {
    return Traction{WithMidEdgeNodes(load.facets, mesh, edges), load.traction};
  }
  Load operator()(const Pressure& load) const {
    return Pressure{WithMidEdgeNodes(load.facets, mesh, edges), load.pressure};
  }
  Load operator()(const SurfaceForce& load) const {
    return SurfaceForce{WithMidEdgeNodes(load.facets, mesh, edges), load.force};
  }
};

LoadCase ToQuadratic(const LoadCase& load_case, const Mesh& mesh,
                     const Edges& edges) {
  LoadCase quadratic;
  quadratic.noise_sd = load_case.noise_sd;
  for (const Load& load : load_case.loads) {
    quadratic.loads.push_back(std::visit(LoadConverter{mesh, edges}, load));
  }
  const ComponentMask measured =
      load_case.observed.size() == 0
          ? ComponentMask(ComponentMask::Constant(3, mesh.NumNodes(), true))
          : load_case.observed;
  quadratic.observed = WithMidEdges(
      measured, ComponentMask(ComponentMask::Constant(3, edges.Size(), false)));
  if (load_case.displacement.size() != 0) {
    const Eigen::Matrix3Xd unknown = Eigen::Matrix3Xd::Zero(3, edges.Size());
    quadratic.displacement = WithMidEdges(load_case.displacement, unknown);
  }
  return quadratic;
}

}  // namespace

Scene QuadraticScene(const Scene& scene) {
  if (scene.mesh.Order() != 1) {
    throw std::invalid_argument(
        "the scene has quadratic elements already; give it with linear ones");
  }
  const Edges edges(scene.mesh);
  Scene quadratic;
  quadratic.mesh = WithMidEdgeNodes(scene.mesh, edges);
  quadratic.supports = WithMidEdgeSupports(scene.supports, scene.mesh, edges);
  for (const LoadCase& load_case : scene.load_cases) {
    quadratic.load_cases.push_back(ToQuadratic(load_case, scene.mesh, edges));
  }
  return quadratic;
}

Eigen::MatrixXd VertexForces(const Mesh& mesh, const Eigen::MatrixXd& force) {
  const Eigen::Index num_vertices = mesh.NumVertices();
  Eigen::MatrixXd vertex_force = force.topRows(3 * num_vertices);
  // An edge of several elements has one node.
  std::vector<bool> is_done(mesh.NumNodes(), false);
  for (Eigen::Index e = 0; e < mesh.NumElements(); ++e) {
    for (Eigen::Index i = 4; i < mesh.elements.rows(); ++i) {
      const int node = mesh.elements(i, e);
      if (is_done[node]) {
        continue;
      }
      is_done[node] = true;
      for (const int end : kTetrahedronEdges[i - 4]) {
        vertex_force.middleRows<3>(3 * Eigen::Index(mesh.elements(end, e))) +=
            0.5 * force.middleRows<3>(3 * Eigen::Index(node));
      }
    }
  }
  return vertex_force;
}

}  // namespace elastimate
