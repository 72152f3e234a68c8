#ifndef ELASTIMATE_PYTHON_SIMULATION_H_
#define ELASTIMATE_PYTHON_SIMULATION_H_

#include <Eigen/Core>
#include <cstdint>

#include "elastimate/core/scene/scene.h"

namespace elastimate {

/// Returns the scene with the displacements of its equilibrium, at parameters
/// in the order of MaterialParameters, as its measurement.  Noise of a standard
/// deviation `noise_sd` [length] is added to what is not held, and given as
/// that of the scene.  With `order` 2, quadratic elements compute the
/// displacements of a mesh of linear ones.  Throws std::invalid_argument for
/// supports that do not hold the specimen, and where there is no equilibrium.
[[nodiscard]] Scene SimulatedScene(const Scene& scene,
                                   const Eigen::VectorXd& parameters, int order,
                                   double noise_sd, std::uint64_t seed);

}  // namespace elastimate

#endif  // ELASTIMATE_PYTHON_SIMULATION_H_
