#ifndef ELASTIMATE_CORE_STRAIN_ENERGY_H_
#define ELASTIMATE_CORE_STRAIN_ENERGY_H_

#include <Eigen/Core>

#include "elastimate/core/elasticity.h"
#include "elastimate/core/mesh.h"

namespace elastimate {

/// Strain energy per volume of each element,
/// mu e:e + (lambda / 2) tr(e)^2 [energy / length^3], num_elements values; in
/// quadratic tetrahedra, where the strain e varies, its mean.
/// `displacement` is 3 x num_nodes.  Precondition: a valid mesh.
/// Cost: one element pass.
Eigen::VectorXd StrainEnergyDensity(const Mesh& mesh,
                                    const IsotropicElasticity& elasticity,
                                    const Eigen::Matrix3Xd& displacement);

}  // namespace elastimate

#endif  // ELASTIMATE_CORE_STRAIN_ENERGY_H_
