#ifndef ELASTIMATE_CORE_MECHANICS_STRAIN_ENERGY_H_
#define ELASTIMATE_CORE_MECHANICS_STRAIN_ENERGY_H_

#include <Eigen/Core>

#include "elastimate/core/laws/elasticity.h"
#include "elastimate/core/mesh/mesh.h"

namespace elastimate {

/// Returns the strain energy per volume of each element, mu e:e + (lambda / 2)
/// tr(e)^2 [energy / length^3], num_elements values.  Where the strain e
/// varies, this is the mean.  lambda is 2 lambda mu / (lambda + 2 mu) in plane
/// stress.  `displacement` is dimension x num_nodes.  Precondition: a valid
/// mesh.  Cost: one element pass.
[[nodiscard]] Eigen::VectorXd StrainEnergyDensity(
    const Mesh& mesh, const IsotropicElasticity& elasticity,
    const Eigen::MatrixXd& displacement);

}  // namespace elastimate

#endif  // ELASTIMATE_CORE_MECHANICS_STRAIN_ENERGY_H_
