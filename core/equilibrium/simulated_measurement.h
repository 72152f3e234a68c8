#ifndef ELASTIMATE_CORE_EQUILIBRIUM_SIMULATED_MEASUREMENT_H_
#define ELASTIMATE_CORE_EQUILIBRIUM_SIMULATED_MEASUREMENT_H_

#include <Eigen/Core>
#include <random>

#include "elastimate/core/materials/elasticity.h"
#include "elastimate/core/scene/scene.h"

namespace elastimate {

/// How the components of noise are distributed, each independently.
enum class NoiseLaw {
  kUniform,   ///< Uniform around zero, as in Becker & Teschner 2007.
  kGaussian,  ///< Normal.
};

/// Measures every load case without noise, by the forward model.
/// Throws std::invalid_argument as ForwardModel does, and std::runtime_error
/// when the stiffness is singular to working precision.  One factorisation.
void Measure(const IsotropicElasticity& elasticity, Scene& scene);

/// The same with quadratic tetrahedra on the mesh of linear ones
/// (QuadraticScene), of which the displacements of the vertices are measured.
void MeasureInFinerWorld(const IsotropicElasticity& elasticity, Scene& scene);

/// Independent noise of mean zero, scaled to exactly this norm.
Eigen::VectorXd DrawNoise(NoiseLaw law, Eigen::Index size, double norm,
                          std::mt19937_64& generator);

}  // namespace elastimate

#endif  // ELASTIMATE_CORE_EQUILIBRIUM_SIMULATED_MEASUREMENT_H_
