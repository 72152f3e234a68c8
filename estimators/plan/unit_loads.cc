#include "elastimate/estimators/plan/unit_loads.h"

#include <algorithm>
#include <set>
#include <variant>

#include "elastimate/core/algebra/dense_algebra.h"
#include "elastimate/core/mesh/axis_names.h"
#include "elastimate/core/mesh/facets.h"
#include "elastimate/core/scene/rigid_motion.h"

namespace elastimate {
namespace {

const Eigen::MatrixXi* FacetsOf(const Load& load) {
  if (const auto* const traction = std::get_if<Traction>(&load)) {
    return &traction->facets;
  }
  if (const auto* const pressure = std::get_if<Pressure>(&load)) {
    return &pressure->facets;
  }
  const auto* const force = std::get_if<SurfaceForce>(&load);
  return force == nullptr ? nullptr : &force->facets;
}

// The columns of some facets of which all vertices are chosen.
template <class IsChosen>
Eigen::MatrixXi FacetsWhere(const Mesh& mesh, const Eigen::MatrixXi& facets,
                            const IsChosen& is_chosen) {
  const int num_vertices = mesh.Topology().NumVerticesOfFace();
  std::vector<Eigen::Index> chosen;
  for (Eigen::Index facet = 0; facet < facets.cols(); ++facet) {
    const auto vertices = facets.col(facet).head(num_vertices);
    if (std::all_of(vertices.begin(), vertices.end(), is_chosen)) {
      chosen.push_back(facet);
    }
  }
  return facets(Eigen::all, chosen);
}

}  // namespace

Eigen::MatrixXi LoadedFacets(const Scene& scene) {
  const Mesh& mesh = scene.mesh;
  const int num_vertices = mesh.Topology().NumVerticesOfFace();
  Eigen::Array<bool, Eigen::Dynamic, 1> has_force =
      Eigen::Array<bool, Eigen::Dynamic, 1>::Constant(mesh.NumNodes(), false);
  std::vector<Eigen::VectorXi> loaded;
  std::set<std::vector<int>> known;
  const auto add = [&](const Eigen::MatrixXi& facets) {
    for (const auto& facet : facets.colwise()) {
      std::vector<int> vertices(facet.begin(), facet.begin() + num_vertices);
      std::sort(vertices.begin(), vertices.end());
      if (known.insert(vertices).second) {
        loaded.emplace_back(facet);
      }
    }
  };
  for (const LoadCase& load_case : scene.load_cases) {
    for (const Load& load : load_case.loads) {
      if (const Eigen::MatrixXi* const facets = FacetsOf(load)) {
        add(*facets);
      } else if (const auto* const nodal = std::get_if<NodalForces>(&load)) {
        has_force = has_force ||
                    (nodal->force.array() != 0).colwise().any().transpose();
      }
    }
  }
  if (has_force.any()) {
    add(FacetsWhere(mesh, BoundaryFacets(mesh),
                    [&](int node) { return has_force(node); }));
  }
  Eigen::MatrixXi facets(mesh.Topology().NumNodesOfFace(), loaded.size());
  for (std::size_t i = 0; i < loaded.size(); ++i) {
    facets.col(Eigen::Index(i)) = loaded[i];
  }
  return facets;
}

std::vector<UnitLoad> UnitLoads(const Mesh& mesh,
                                const Eigen::MatrixXi& facets) {
  const int dimension = mesh.Dimension();
  Eigen::VectorXd area = Eigen::VectorXd::Zero(mesh.NumNodes());
  for (const auto& facet : facets.colwise()) {
    const Eigen::VectorXd weights = WeightsOfFacet(mesh, facet).area;
    for (Eigen::Index i = 0; i < facet.size(); ++i) {
      area(facet(i)) += weights(i);
    }
  }
  const Eigen::VectorXd centroid = mesh.nodes * area / area.sum();
  const int num_motions = NumRigidMotions(dimension);
  // Nodal forces of the tractions that look like the rigid motions, side by
  // side: the work of one of them on another is a resultant.
  const Eigen::MatrixXd motions =
      RigidMotionsOf(mesh.nodes.colwise() - centroid);
  const Eigen::VectorXd of_dofs =
      area.transpose().replicate(dimension, 1).reshaped();
  const Eigen::MatrixXd tractions = of_dofs.asDiagonal() * motions;
  const Eigen::MatrixXd forces =
      tractions * Inverse(motions.transpose() * tractions);
  std::vector<UnitLoad> loads;
  for (int i = 0; i < num_motions; ++i) {
    const std::string name =
        i < dimension ? std::string("force along ") + kAxisNames[i]
        : dimension == 2
            ? "moment"
            : std::string("moment about ") + kAxisNames[i - dimension];
    loads.push_back(
        {name, {forces.col(i).reshaped(dimension, mesh.NumNodes())}});
  }
  return loads;
}

}  // namespace elastimate
