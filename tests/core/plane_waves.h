#ifndef ELASTIMATE_TESTS_CORE_PLANE_WAVES_H_
#define ELASTIMATE_TESTS_CORE_PLANE_WAVES_H_

#include <Eigen/Core>

#include "elastimate/core/laws/elasticity.h"

namespace elastimate::testing {

/// A manufactured solution: each component is a plane wave,
/// u_i = c_i sin(k_i . x + p_i), so that the Laplacian of u is -|k_i|^2 u_i and
/// grad(div u) is -sum_i k_ii k_i u_i.
struct PlaneWaves {
  Eigen::Vector3d amplitude{1, -0.8, 0.6};
  Eigen::Vector3d phase{0.3, 1.1, -0.4};
  Eigen::Matrix3d wave;  ///< Row i is k_i.

  PlaneWaves() { wave << 2, 1, -1, 1, 2.5, 0.5, -0.5, 1, 2; }

  Eigen::Vector3d Displacement(const Eigen::Vector3d& x) const {
    return amplitude.array() * (wave * x + phase).array().sin();
  }
  /// -div sigma = -mu Laplacian(u) - (lambda + mu) grad(div u).
  Eigen::Vector3d BodyForce(const IsotropicElasticity& elasticity,
                            const Eigen::Vector3d& x) const {
    const double mu = elasticity.ShearModulus();
    const double lambda = elasticity.LameLambda();
    const Eigen::Vector3d u = Displacement(x);
    const Eigen::Vector3d gradient_of_divergence =
        -wave.transpose() * wave.diagonal().cwiseProduct(u);
    const Eigen::Vector3d laplacian =
        -wave.rowwise().squaredNorm().cwiseProduct(u);
    return -mu * laplacian - (lambda + mu) * gradient_of_divergence;
  }
};

}  // namespace elastimate::testing

#endif  // ELASTIMATE_TESTS_CORE_PLANE_WAVES_H_
