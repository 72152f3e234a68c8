#ifndef ELASTIMATE_TESTS_CORE_MECHANICS_STRAIN_ENERGY_H_
#define ELASTIMATE_TESTS_CORE_MECHANICS_STRAIN_ENERGY_H_

#include "elastimate/core/laws/elasticity.h"
#include "elastimate/core/mechanics/internal_forces.h"

namespace elastimate::testing {

/// Returns the strain energy per volume of each element of one isotropic
/// material, for a displacement of dimension x num_nodes.
inline Eigen::VectorXd StrainEnergyDensity(
    const Mesh& mesh, const IsotropicElasticity& elasticity,
    const Eigen::MatrixXd& displacement) {
  const InternalForces forces(mesh, {});
  return forces.EnergyDensity(
      forces.Parameters().Moduli(elasticity.Parameters()),
      displacement.reshaped());
}

}  // namespace elastimate::testing

#endif  // ELASTIMATE_TESTS_CORE_MECHANICS_STRAIN_ENERGY_H_
