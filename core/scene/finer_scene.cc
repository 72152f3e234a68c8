#include "elastimate/core/scene/finer_scene.h"

#include <utility>

#include "elastimate/core/mesh/finer_nodes.h"
#include "elastimate/core/scene/linear_scene.h"
#include "elastimate/core/scene/loads.h"
#include "elastimate/core/scene/quadratic_scene.h"

namespace elastimate {
namespace {

// Balances nodal forces, which were spread over facets that are not curved.
void BalanceLoads(const Scene& scene, const FinerNodes& nodes, Scene& finer) {
  // Facets and elements that are flat leave rounding, which is no load.
  constexpr double kRounding = 1e-12;
  const Eigen::MatrixXd loads = AssembleLoadCases(scene);
  const Eigen::MatrixXd rest = loads - nodes.Restrict(AssembleLoadCases(finer));
  for (std::size_t k = 0; k < finer.load_cases.size(); ++k) {
    if (rest.col(Eigen::Index(k)).norm() <=
        kRounding * loads.col(Eigen::Index(k)).norm()) {
      continue;
    }
    NodalForces forces{
        Eigen::MatrixXd::Zero(scene.mesh.Dimension(), finer.mesh.NumNodes())};
    forces.force.leftCols(scene.mesh.NumNodes()) =
        rest.col(Eigen::Index(k))
            .reshaped(scene.mesh.Dimension(), scene.mesh.NumNodes());
    finer.load_cases[k].loads.emplace_back(std::move(forces));
  }
}

// Moves a new node as the elements say, rather than by the mean of its two
// neighbours, where it and all the nodes around it are held.
void MoveSupports(const FinerNodes& nodes, Supports& supports) {
  const FinerNodes::Weights& weights = nodes.WeightsOfNodes();
  for (Eigen::Index row = 0; row < nodes.NumMiddles(); ++row) {
    const Eigen::Index node = nodes.NumNodes() + row;
    for (Eigen::Index i = 0; i < supports.held.rows(); ++i) {
      bool is_held = supports.held(i, node);
      double displacement = 0;
      for (FinerNodes::Weights::InnerIterator weight(weights, row); weight;
           ++weight) {
        is_held = is_held && supports.held(i, weight.col());
        displacement += weight.value() * supports.displacement(i, weight.col());
      }
      if (is_held) {
        supports.displacement(i, node) = displacement;
      }
    }
  }
}

}  // namespace

Scene FinerScene(const Scene& scene) {
  Scene finer = QuadraticScene(LinearScene(scene));
  if (IsCurved(scene.mesh.kind)) {
    const FinerNodes nodes(scene.mesh, finer.mesh);
    finer.mesh.kind = scene.mesh.kind;
    finer.mesh.nodes =
        nodes.Interpolate(scene.mesh.nodes.reshaped())
            .reshaped(scene.mesh.Dimension(), finer.mesh.NumNodes());
    MoveSupports(nodes, finer.supports);
    for (LoadCase& load_case : finer.load_cases) {
      if (load_case.supports) {
        MoveSupports(nodes, *load_case.supports);
      }
    }
    BalanceLoads(scene, nodes, finer);
  }
  return finer;
}

}  // namespace elastimate
