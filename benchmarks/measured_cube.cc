#include "benchmarks/measured_cube.h"

#include "elastimate/core/mechanics/stiffness_product.h"
#include "elastimate/io/examples/example_scenes.h"

namespace elastimate {

Scene MeasuredCube(int cells, const IsotropicElasticity& elasticity) {
  CuboidOptions options;
  options.cells.setConstant(cells);
  options.size.setOnes();
  Scene scene = CuboidScene(options);
  const auto x = scene.mesh.nodes.row(0).array();
  const auto y = scene.mesh.nodes.row(1).array();
  const auto z = scene.mesh.nodes.row(2).array();
  Eigen::MatrixXd displacement(3, scene.mesh.NumNodes());
  displacement.row(0) = z * (0.02 * x + 0.01 * z);
  displacement.row(1) = z * (0.01 * y - 0.02 * x * z);
  displacement.row(2) = z * (-0.05 - 0.03 * x * y);
  const StiffnessProducts products =
      MultiplyStiffnessBasis(scene.mesh, displacement.reshaped());
  NodalForces forces{(elasticity.StiffnessScale(SectionModel::kSolid) *
                      (products.h + elasticity.poisson_ratio * products.j))
                         .reshaped(3, displacement.cols())};
  forces.force = scene.supports.held.select(0, forces.force);
  scene.load_cases[0].loads = {forces};
  scene.load_cases[0].displacement = displacement;
  scene.origin = Origin::kComputed;
  return scene;
}

}  // namespace elastimate
