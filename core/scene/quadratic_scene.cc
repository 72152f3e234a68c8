#include "elastimate/core/scene/quadratic_scene.h"

#include <algorithm>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include "elastimate/core/mesh/edges.h"
#include "elastimate/core/mesh/facets.h"
#include "elastimate/core/scene/spread_loads.h"
#include "elastimate/core/scene/support_ends.h"

namespace elastimate {
namespace {

// Returns `values` with further columns for the mid-edge nodes.
template <typename Array>
Array WithMidEdges(const Array& values, const Array& mid_edges) {
  Array all(values.rows(), values.cols() + mid_edges.cols());
  all << values, mid_edges;
  return all;
}

Eigen::MatrixXd MeanOfEnds(const Eigen::MatrixXd& values, const Edges& edges) {
  return 0.5 * (values(Eigen::all, edges.Ends().row(0)) +
                values(Eigen::all, edges.Ends().row(1)));
}

Mesh WithMidEdgeNodes(const Mesh& mesh, const Edges& edges) {
  const ElementTopology& topology = mesh.Topology();
  Mesh quadratic;
  quadratic.kind = QuadraticKind(mesh.kind);
  quadratic.section = mesh.section;
  quadratic.regions = mesh.regions;
  quadratic.nodes = WithMidEdges(mesh.nodes, MeanOfEnds(mesh.nodes, edges));
  quadratic.elements.resize(quadratic.Topology().num_nodes, mesh.NumElements());
  quadratic.elements.topRows(topology.num_vertices) = mesh.elements;
  for (Eigen::Index e = 0; e < mesh.NumElements(); ++e) {
    for (std::size_t i = 0; i < topology.edges.size(); ++i) {
      quadratic.elements(topology.num_vertices + Eigen::Index(i), e) =
          static_cast<int>(mesh.NumNodes() +
                           edges.Find(mesh.elements(topology.edges[i][0], e),
                                      mesh.elements(topology.edges[i][1], e)));
    }
  }
  return quadratic;
}

// Returns the vertices at the ends of mid-edge node i of a facet of a simplex.
std::pair<int, int> EndsOfFacetEdge(Eigen::Index i, Eigen::Index num_vertices) {
  return {static_cast<int>(i), static_cast<int>((i + 1) % num_vertices)};
}

// Returns how many edges a facet of a simplex has: a triangle three, an edge
// one.
Eigen::Index NumFacetEdges(const Mesh& mesh) {
  return mesh.Dimension() == 3 ? 3 : 1;
}

// Tells which edges cross the interior from one node of the surface to another.
std::vector<bool> CrossingEdges(const Mesh& mesh, const Edges& edges) {
  std::vector<bool> node_on_surface(mesh.NumNodes(), false);
  std::vector<bool> edge_on_surface(edges.Size(), false);
  const Eigen::MatrixXi facets = BoundaryFacets(mesh);
  for (Eigen::Index facet = 0; facet < facets.cols(); ++facet) {
    for (Eigen::Index i = 0; i < NumFacetEdges(mesh); ++i) {
      const auto [a, b] = EndsOfFacetEdge(i, facets.rows());
      node_on_surface[facets(a, facet)] = true;
      node_on_surface[facets(b, facet)] = true;
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

// Returns the components of the edges of those elements that are held at a node
// inside the specimen, where no support of its surface is.
ComponentMask HeldInVolume(const ComponentMask& held, const Mesh& mesh,
                           const Edges& edges) {
  std::vector<bool> on_surface(mesh.NumNodes(), false);
  const Eigen::MatrixXi facets = BoundaryFacets(mesh);
  for (const int node : facets.reshaped()) {
    on_surface[node] = true;
  }
  ComponentMask in_volume =
      ComponentMask::Constant(mesh.Dimension(), edges.Size(), false);
  for (Eigen::Index e = 0; e < mesh.NumElements(); ++e) {
    const auto nodes = mesh.elements.col(e);
    for (Eigen::Index i = 0; i < held.rows(); ++i) {
      if (std::none_of(nodes.begin(), nodes.end(), [&](int node) {
            return !on_surface[node] && held(i, node);
          })) {
        continue;
      }
      for (const auto& ends : mesh.Topology().edges) {
        in_volume(i, edges.Find(nodes(ends[0]), nodes(ends[1]))) = true;
      }
    }
  }
  return in_volume;
}

// Returns the nodes, and behind them the mid-edge nodes between two of them.
template <class Predicate>
std::vector<int> WithMidEdgeNodes(const std::vector<int>& nodes,
                                  const Mesh& mesh, const Edges& edges,
                                  const Predicate& is_taken) {
  std::vector<bool> is_chosen(mesh.NumNodes(), false);
  for (const int node : nodes) {
    is_chosen[node] = true;
  }
  std::vector<int> all = nodes;
  for (Eigen::Index edge = 0; edge < edges.Size(); ++edge) {
    if (is_chosen[edges.Ends()(0, edge)] && is_chosen[edges.Ends()(1, edge)] &&
        is_taken(edge)) {
      all.push_back(static_cast<int>(mesh.NumNodes() + edge));
    }
  }
  return all;
}

Supports WithMidEdgeSupports(const Supports& supports, const Mesh& mesh,
                             const Edges& edges) {
  const std::vector<bool> crossing = CrossingEdges(mesh, edges);
  ComponentMask held = supports.held(Eigen::all, edges.Ends().row(0)) &&
                       supports.held(Eigen::all, edges.Ends().row(1));
  const ComponentMask in_volume = HeldInVolume(supports.held, mesh, edges);
  for (Eigen::Index edge = 0; edge < edges.Size(); ++edge) {
    if (crossing[edge]) {
      held.col(edge) = held.col(edge) && in_volume.col(edge);
    }
  }
  Eigen::MatrixXd displacement = MeanOfEnds(supports.displacement, edges);
  const Eigen::MatrixXd middles = MeanOfEnds(mesh.nodes, edges);
  for (const HeldBox& box : supports.boxes) {
    for (Eigen::Index edge = 0; edge < edges.Size(); ++edge) {
      if (!box.Contains(middles.col(edge))) {
        continue;
      }
      for (Eigen::Index i = 0; i < held.rows(); ++i) {
        if (box.components(i)) {
          held(i, edge) = true;
          displacement(i, edge) = box.displacement(i);
        }
      }
    }
  }
  ComponentMask unknown;
  if (supports.unknown.size() != 0) {
    unknown = WithMidEdges(
        supports.unknown,
        ComponentMask(held &&
                      supports.unknown(Eigen::all, edges.Ends().row(0)) &&
                      supports.unknown(Eigen::all, edges.Ends().row(1))));
  }
  std::vector<RigidFace> rigid_faces;
  for (const RigidFace& face : supports.rigid_faces) {
    rigid_faces.push_back(
        {WithMidEdgeNodes(face.nodes, mesh, edges,
                          [&](Eigen::Index edge) { return !crossing[edge]; }),
         face.components});
  }
  Supports quadratic = {WithMidEdges(supports.held, held),
                        WithMidEdges(supports.displacement, displacement),
                        supports.boxes, unknown, rigid_faces};
  quadratic.middles = supports.middles;
  for (Eigen::Index edge = 0; edge < edges.Size(); ++edge) {
    const auto node = mesh.NumNodes() + edge;
    if (unknown.size() != 0 && unknown.col(node).any()) {
      quadratic.middles.push_back(
          {static_cast<int>(node),
           {edges.Ends()(0, edge), edges.Ends()(1, edge)}});
    }
  }
  return quadratic;
}

Eigen::MatrixXi WithMidEdgeNodes(const Eigen::MatrixXi& facets,
                                 const Mesh& mesh, const Edges& edges) {
  const Eigen::Index num_vertices = facets.rows();
  Eigen::MatrixXi quadratic(num_vertices + NumFacetEdges(mesh), facets.cols());
  quadratic.topRows(num_vertices) = facets;
  for (Eigen::Index facet = 0; facet < facets.cols(); ++facet) {
    for (Eigen::Index i = 0; i < NumFacetEdges(mesh); ++i) {
      const auto [a, b] = EndsOfFacetEdge(i, num_vertices);
      const Eigen::Index edge = edges.Find(facets(a, facet), facets(b, facet));
      if (edge < 0) {
        throw std::invalid_argument("facet " + std::to_string(facet) +
                                    " of a load is not a face of a " +
                                    std::string(mesh.Topology().shape) +
                                    "; take the facets from the mesh");
      }
      quadratic(num_vertices + i, facet) =
          static_cast<int>(mesh.NumNodes() + edge);
    }
  }
  return quadratic;
}

// One overload per kind of load.
struct LoadConverter {
  const Mesh& mesh;
  const Edges& edges;

  Load operator()(const NodalForces& load) const {
    const Eigen::MatrixXd none =
        Eigen::MatrixXd::Zero(mesh.Dimension(), edges.Size());
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

LoadCase ToQuadratic(const LoadCase& load_case, const ComponentMask& held,
                     const Mesh& mesh, const Edges& edges) {
  LoadCase quadratic;
  quadratic.noise_sd = load_case.noise_sd;
  quadratic.points = load_case.points;
  for (const Load& load : SpreadLoads(mesh, held, load_case.loads)) {
    quadratic.loads.push_back(std::visit(LoadConverter{mesh, edges}, load));
  }
  const ComponentMask measured =
      load_case.observed.size() == 0
          ? ComponentMask(ComponentMask::Constant(mesh.Dimension(),
                                                  mesh.NumNodes(), true))
          : load_case.observed;
  quadratic.observed =
      WithMidEdges(measured, ComponentMask(ComponentMask::Constant(
                                 mesh.Dimension(), edges.Size(), false)));
  if (load_case.displacement.size() != 0) {
    const Eigen::MatrixXd unknown =
        Eigen::MatrixXd::Zero(mesh.Dimension(), edges.Size());
    quadratic.displacement = WithMidEdges(load_case.displacement, unknown);
  }
  if (load_case.supports) {
    quadratic.supports = WithMidEdgeSupports(*load_case.supports, mesh, edges);
  }
  for (Resultant resultant : load_case.resultants) {
    resultant.nodes = WithMidEdgeNodes(resultant.nodes, mesh, edges,
                                       [](Eigen::Index) { return true; });
    quadratic.resultants.push_back(resultant);
  }
  return quadratic;
}

}  // namespace

Scene QuadraticScene(const Scene& scene) {
  if (scene.mesh.Order() != 1) {
    throw std::invalid_argument(
        "the scene has quadratic elements already; give a scene with linear "
        "elements");
  }
  if (!HasQuadraticKind(scene.mesh.kind)) {
    throw std::invalid_argument("there are no quadratic " +
                                std::string(scene.mesh.Topology().shapes) +
                                "; use linear elements (--order=1)");
  }
  const Edges edges(scene.mesh);
  Scene quadratic;
  quadratic.mesh = WithMidEdgeNodes(scene.mesh, edges);
  quadratic.materials = scene.materials;
  quadratic.supports = WithMidEdgeSupports(scene.supports, scene.mesh, edges);
  quadratic.supports.in_doubt =
      FindSupportEnds(scene.supports, scene.mesh, edges,
                      quadratic.supports.held.rightCols(edges.Size()));
  quadratic.is_rigid_motion_free = scene.is_rigid_motion_free;
  quadratic.origin = scene.origin;
  for (const LoadCase& load_case : scene.load_cases) {
    quadratic.load_cases.push_back(
        ToQuadratic(load_case, scene.supports.held, scene.mesh, edges));
  }
  return quadratic;
}

}  // namespace elastimate
