#include "elastimate/core/equilibrium/simulated_measurement.h"

#include <stdexcept>

#include "elastimate/core/equilibrium/forward_model.h"
#include "elastimate/core/scene/loads.h"
#include "elastimate/core/scene/quadratic_scene.h"

namespace elastimate {

void Measure(const IsotropicElasticity& elasticity, Scene& scene) {
  ForwardModel model(scene.mesh, scene.supports, AssembleLoadCases(scene));
  if (!model.SetPoissonRatio(elasticity.poisson_ratio)) {
    throw std::runtime_error(
        "the stiffness matrix is singular to working precision");
  }
  const Eigen::MatrixXd displacement =
      model.Displacement(elasticity.youngs_modulus);
  for (std::size_t k = 0; k < scene.load_cases.size(); ++k) {
    scene.load_cases[k].displacement =
        displacement.col(Eigen::Index(k))
            .reshaped(scene.mesh.Dimension(), scene.mesh.NumNodes());
  }
}

void MeasureInFinerWorld(const IsotropicElasticity& elasticity, Scene& scene) {
  Scene quadratic = QuadraticScene(scene);
  Measure(elasticity, quadratic);
  for (std::size_t k = 0; k < scene.load_cases.size(); ++k) {
    scene.load_cases[k].displacement =
        quadratic.load_cases[k].displacement.leftCols(scene.mesh.NumNodes());
  }
}

Eigen::VectorXd DrawNoise(NoiseLaw law, Eigen::Index size, double norm,
                          std::mt19937_64& generator) {
  std::uniform_real_distribution<double> uniform(-1, 1);
  std::normal_distribution<double> gaussian;
  Eigen::VectorXd noise(size);
  for (double& value : noise) {
    value =
        law == NoiseLaw::kUniform ? uniform(generator) : gaussian(generator);
  }
  return norm / noise.norm() * noise;
}

}  // namespace elastimate
