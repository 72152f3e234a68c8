// Young's modulus and Poisson's ratio of a block of gelatine from the
// displacements of its nodes.  Needs the libraries core and estimators only.
//
//            z
//            |  100 N down, spread over the top nodes
//        +---v---+
//       /       /|
//      +-------+ |     the bottom, z = 0, is glued to the table
//      |       | +
//      |       |/
//   ///+-------+///
//
// The "measurement" comes from the library's own forward model here; in an
// experiment it comes from a camera or a scanner.

#include <elastimate/core/equilibrium/simulated_measurement.h>
#include <elastimate/core/scene/scene.h>
#include <elastimate/estimators/registry.h>

#include <iostream>

namespace {

using elastimate::LoadCase;
using elastimate::Mesh;
using elastimate::NodalForces;
using elastimate::Scene;

// 1. The mesh: one cube of edge 0.1 m with a node in its middle, cut into the
// twelve tetrahedra that join the middle with half a face each.
Mesh MakeMesh() {
  Mesh mesh;
  mesh.nodes.resize(3, 9);
  mesh.nodes << 0, 1, 1, 0, 0, 1, 1, 0, 0.5,  //
      0, 0, 1, 1, 0, 0, 1, 1, 0.5,            //
      0, 0, 0, 0, 1, 1, 1, 1, 0.5;
  mesh.nodes *= 0.1;
  mesh.elements.resize(4, 12);
  mesh.elements << 0, 0, 4, 4, 0, 0, 1, 1, 2, 2, 3, 3,  //
      1, 2, 5, 6, 1, 5, 2, 6, 3, 7, 0, 4,               //
      2, 3, 6, 7, 5, 4, 6, 5, 7, 6, 4, 7,               //
      8, 8, 8, 8, 8, 8, 8, 8, 8, 8, 8, 8;
  return mesh;
}

}  // namespace

int main() {
  Scene scene;
  scene.mesh = MakeMesh();

  // 2. The supports: nodes 0 to 3, at the bottom, are held at zero.
  scene.supports.held.setConstant(3, 9, false);
  scene.supports.held.leftCols(4).setConstant(true);
  scene.supports.displacement.setZero(3, 9);

  // 3. The load: 25 N down on each of the nodes 4 to 7.
  NodalForces forces{Eigen::MatrixXd::Zero(3, 9)};
  forces.force.row(2).segment(4, 4).setConstant(-25);
  LoadCase load_case;
  load_case.loads = {forces};
  scene.load_cases = {load_case};

  // 4. The measurement.
  elastimate::Measure({20e3, 0.4}, scene);

  // 5. The estimate.
  const auto estimator = elastimate::MakeEstimator("closed-form");
  const elastimate::Estimate estimate = estimator->Run(scene, {});
  if (!estimate.IsUsable()) {
    std::cerr << estimate.message << "\n";
    return 1;
  }
  std::cout << "E = " << estimate.elasticity.youngs_modulus
            << " Pa, nu = " << estimate.elasticity.poisson_ratio << "\n";
  return 0;
}
