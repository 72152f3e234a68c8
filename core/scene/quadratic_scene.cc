#include "elastimate/core/scene/quadratic_scene.h"

#include <algorithm>
#include <stdexcept>
#include <string>
#include <vector>

#include "elastimate/core/mesh/facets.h"
#include "elastimate/core/mesh/middles.h"
#include "elastimate/core/scene/spread_loads.h"
#include "elastimate/core/scene/support_ends.h"

namespace elastimate {
namespace {

// Returns `values` with further columns for the middle nodes.
template <typename Array>
Array WithMiddles(const Array& values, const Array& of_middles) {
  Array all(values.rows(), values.cols() + of_middles.cols());
  all << values, of_middles;
  return all;
}

// Returns the components that all vertices of a middle have.
ComponentMask OfAllVertices(const ComponentMask& mask, const Middles& middles) {
  ComponentMask of_middles(mask.rows(), middles.Size());
  for (Eigen::Index i = 0; i < middles.Size(); ++i) {
    of_middles.col(i) = mask(Eigen::all, middles.Vertices()[i]).rowwise().all();
  }
  return of_middles;
}

Mesh WithMiddleNodes(const Mesh& mesh, const Middles& middles) {
  Mesh quadratic;
  quadratic.kind = QuadraticKind(mesh.kind);
  quadratic.section = mesh.section;
  quadratic.regions = mesh.regions;
  quadratic.nodes =
      WithMiddles(mesh.nodes, middles.Vertices().MeansOf(mesh.nodes));
  quadratic.elements.resize(quadratic.Topology().num_nodes, mesh.NumElements());
  quadratic.elements << mesh.elements,
      (middles.OfElements().array() + int(mesh.NumNodes())).matrix();
  return quadratic;
}

// Returns the vertices of each middle of a facet.
std::vector<std::vector<int>> MiddlesOfFacet(
    const Mesh& mesh, const Eigen::Ref<const Eigen::VectorXi>& facet) {
  std::vector<std::vector<int>> middles;
  for (const std::vector<int>& places : mesh.Topology().middles_of_face) {
    middles.emplace_back();
    for (const int place : places) {
      middles.back().push_back(facet(place));
    }
  }
  return middles;
}

// Tells which middles are inside the specimen while all their vertices are on
// its surface.
std::vector<bool> CrossingMiddles(const Mesh& mesh, const Middles& middles,
                                  const Eigen::MatrixXi& facets) {
  std::vector<bool> node_on_surface(mesh.NumNodes(), false);
  std::vector<bool> middle_on_surface(middles.Size(), false);
  for (const auto& facet : facets.colwise()) {
    for (const int node : facet) {
      node_on_surface[node] = true;
    }
    for (const std::vector<int>& vertices : MiddlesOfFacet(mesh, facet)) {
      middle_on_surface[middles.Find(vertices)] = true;
    }
  }
  std::vector<bool> crossing(middles.Size());
  for (Eigen::Index i = 0; i < middles.Size(); ++i) {
    const auto vertices = middles.Vertices()[i];
    crossing[i] = !middle_on_surface[i] &&
                  std::all_of(vertices.begin(), vertices.end(),
                              [&](int node) { return node_on_surface[node]; });
  }
  return crossing;
}

// Returns the components of the middles of those elements that are held at a
// node inside the specimen, where no support of its surface is.
ComponentMask HeldInVolume(const ComponentMask& held, const Mesh& mesh,
                           const Middles& middles,
                           const Eigen::MatrixXi& facets) {
  std::vector<bool> on_surface(mesh.NumNodes(), false);
  for (const int node : facets.reshaped()) {
    on_surface[node] = true;
  }
  ComponentMask in_volume =
      ComponentMask::Constant(mesh.Dimension(), middles.Size(), false);
  for (Eigen::Index e = 0; e < mesh.NumElements(); ++e) {
    const auto nodes = mesh.elements.col(e);
    for (Eigen::Index i = 0; i < held.rows(); ++i) {
      if (std::any_of(nodes.begin(), nodes.end(), [&](int node) {
            return !on_surface[node] && held(i, node);
          })) {
        in_volume.row(i)(middles.OfElements().col(e)) = true;
      }
    }
  }
  return in_volume;
}

// Returns the nodes, and behind them the middle nodes all of whose vertices are
// among them.
template <class Predicate>
std::vector<int> WithMiddleNodes(const std::vector<int>& nodes,
                                 const Mesh& mesh, const Middles& middles,
                                 const Predicate& is_taken) {
  std::vector<bool> is_chosen(mesh.NumNodes(), false);
  for (const int node : nodes) {
    is_chosen[node] = true;
  }
  std::vector<int> all = nodes;
  for (Eigen::Index i = 0; i < middles.Size(); ++i) {
    const auto vertices = middles.Vertices()[i];
    if (std::all_of(vertices.begin(), vertices.end(),
                    [&](int node) { return is_chosen[node]; }) &&
        is_taken(i)) {
      all.push_back(static_cast<int>(mesh.NumNodes() + i));
    }
  }
  return all;
}

Supports WithMiddleSupports(const Supports& supports, const Mesh& mesh,
                            const Eigen::MatrixXi& surface,
                            const Middles& middles) {
  const std::vector<bool> crossing = CrossingMiddles(mesh, middles, surface);
  ComponentMask held = OfAllVertices(supports.held, middles);
  const ComponentMask in_volume =
      HeldInVolume(supports.held, mesh, middles, surface);
  for (Eigen::Index i = 0; i < middles.Size(); ++i) {
    if (crossing[i]) {
      held.col(i) = held.col(i) && in_volume.col(i);
    }
  }
  Eigen::MatrixXd displacement =
      middles.Vertices().MeansOf(supports.displacement);
  const Eigen::MatrixXd positions = middles.Vertices().MeansOf(mesh.nodes);
  for (const HeldBox& box : supports.boxes) {
    for (Eigen::Index i = 0; i < middles.Size(); ++i) {
      if (!box.Contains(positions.col(i))) {
        continue;
      }
      for (Eigen::Index k = 0; k < held.rows(); ++k) {
        if (box.components(k)) {
          held(k, i) = true;
          displacement(k, i) = box.displacement(k);
        }
      }
    }
  }
  ComponentMask unknown;
  if (supports.unknown.size() != 0) {
    unknown = WithMiddles(
        supports.unknown,
        ComponentMask(held && OfAllVertices(supports.unknown, middles)));
  }
  std::vector<RigidFace> rigid_faces;
  for (const RigidFace& face : supports.rigid_faces) {
    rigid_faces.push_back(
        {WithMiddleNodes(face.nodes, mesh, middles,
                         [&](Eigen::Index i) { return !crossing[i]; }),
         face.components});
  }
  Supports quadratic = {WithMiddles(supports.held, held),
                        WithMiddles(supports.displacement, displacement),
                        supports.boxes, unknown, rigid_faces};
  quadratic.middles = supports.middles;
  for (Eigen::Index i = 0; i < middles.Size(); ++i) {
    const auto node = mesh.NumNodes() + i;
    if (unknown.size() != 0 && unknown.col(node).any()) {
      const auto vertices = middles.Vertices()[i];
      quadratic.middles.push_back(
          {static_cast<int>(node), {vertices.begin(), vertices.end()}});
    }
  }
  return quadratic;
}

Eigen::MatrixXi WithMiddleNodes(const Eigen::MatrixXi& facets, const Mesh& mesh,
                                const Middles& middles) {
  const Eigen::Index num_vertices = facets.rows();
  Eigen::MatrixXi quadratic(
      num_vertices + Eigen::Index(mesh.Topology().middles_of_face.size()),
      facets.cols());
  quadratic.topRows(num_vertices) = facets;
  for (Eigen::Index facet = 0; facet < facets.cols(); ++facet) {
    Eigen::Index row = num_vertices;
    for (const auto& vertices : MiddlesOfFacet(mesh, facets.col(facet))) {
      const Eigen::Index middle = middles.Find(vertices);
      if (middle < 0) {
        throw std::invalid_argument("facet " + std::to_string(facet) +
                                    " of a load is not a face of a " +
                                    std::string(mesh.Topology().shape) +
                                    "; take the facets from the mesh");
      }
      quadratic(row++, facet) = static_cast<int>(mesh.NumNodes() + middle);
    }
  }
  return quadratic;
}

// One overload per kind of load.
struct LoadConverter {
  const Mesh& mesh;
  const Middles& middles;

  Load operator()(const NodalForces& load) const {
    const Eigen::MatrixXd none =
        Eigen::MatrixXd::Zero(mesh.Dimension(), middles.Size());
    return NodalForces{WithMiddles(load.force, none)};
  }
  Load operator()(const BodyForce& load) const { return load; }
  Load operator()(const Traction& load) const {
    return Traction{WithMiddleNodes(load.facets, mesh, middles), load.traction};
  }
  Load operator()(const Pressure& load) const {
    return Pressure{WithMiddleNodes(load.facets, mesh, middles), load.pressure,
                    load.follows};
  }
  Load operator()(const SurfaceForce& load) const {
    return SurfaceForce{WithMiddleNodes(load.facets, mesh, middles),
                        load.force};
  }
};

LoadCase ToQuadratic(const LoadCase& load_case, const ComponentMask& held,
                     const Mesh& mesh, const Eigen::MatrixXi& surface,
                     const Middles& middles) {
  LoadCase quadratic;
  quadratic.noise_sd = load_case.noise_sd;
  quadratic.points = load_case.points;
  for (const Load& load : SpreadLoads(mesh, surface, held, load_case.loads)) {
    quadratic.loads.push_back(std::visit(LoadConverter{mesh, middles}, load));
  }
  const ComponentMask measured =
      load_case.observed.size() == 0
          ? ComponentMask(ComponentMask::Constant(mesh.Dimension(),
                                                  mesh.NumNodes(), true))
          : load_case.observed;
  quadratic.observed =
      WithMiddles(measured, ComponentMask(ComponentMask::Constant(
                                mesh.Dimension(), middles.Size(), false)));
  if (load_case.displacement.size() != 0) {
    const Eigen::MatrixXd unknown =
        Eigen::MatrixXd::Zero(mesh.Dimension(), middles.Size());
    quadratic.displacement = WithMiddles(load_case.displacement, unknown);
  }
  if (load_case.supports) {
    quadratic.supports =
        WithMiddleSupports(*load_case.supports, mesh, surface, middles);
  }
  for (Resultant resultant : load_case.resultants) {
    resultant.nodes = WithMiddleNodes(resultant.nodes, mesh, middles,
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
  const Middles middles(scene.mesh);
  const Eigen::MatrixXi surface = BoundaryFacets(scene.mesh);
  Scene quadratic;
  quadratic.mesh = WithMiddleNodes(scene.mesh, middles);
  quadratic.materials = scene.materials;
  quadratic.supports =
      WithMiddleSupports(scene.supports, scene.mesh, surface, middles);
  quadratic.supports.in_doubt =
      FindSupportEnds(scene.supports, scene.mesh, surface, middles,
                      quadratic.supports.held.rightCols(middles.Size()));
  quadratic.is_rigid_motion_free = scene.is_rigid_motion_free;
  quadratic.origin = scene.origin;
  for (const LoadCase& load_case : scene.load_cases) {
    quadratic.load_cases.push_back(ToQuadratic(load_case, scene.supports.held,
                                               scene.mesh, surface, middles));
  }
  return quadratic;
}

}  // namespace elastimate
