#include "benchmarks/measured_body.h"

#include "elastimate/core/mechanics/stiffness_product.h"
#include "elastimate/io/examples/example_scenes.h"

namespace elastimate {
namespace {

Scene Measured(Scene scene, const Eigen::ArrayXd& height,
               const IsotropicElasticity& elasticity) {
  const auto x = scene.mesh.nodes.row(0).array();
  const auto y = scene.mesh.nodes.row(1).array();
  const auto z = height.transpose();
  Eigen::MatrixXd displacement(3, scene.mesh.NumNodes());
  displacement.row(0) = z * (2 * x + z);
  displacement.row(1) = z * (y - 2 * x * z);
  displacement.row(2) = z * (-5 - 3 * x * y);
  displacement *= 1e-4;  // Estimators of small strains refuse larger ones.
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

}  // namespace

Scene MeasuredCube(int cells, const IsotropicElasticity& elasticity) {
  CuboidOptions options;
  options.cells.setConstant(cells);
  options.size.setOnes();
  Scene scene = CuboidScene(options);
  const Eigen::ArrayXd z = scene.mesh.nodes.row(2);
  return Measured(std::move(scene), z, elasticity);
}

Scene MeasuredOrgan(int tetrahedra, const IsotropicElasticity& elasticity) {
  OrganOptions options;
  options.tetrahedra = tetrahedra;
  options.length = 1;
  Scene scene = OrganScene(options);
  const Eigen::ArrayXd z = scene.mesh.nodes.row(2);
  const double top_of_support =
      z.minCoeff() + 0.1 * (z.maxCoeff() - z.minCoeff());
  scene.supports.held.rowwise() = (z <= top_of_support).transpose();
  return Measured(std::move(scene), (z - top_of_support).max(0.0), elasticity);
}

}  // namespace elastimate
