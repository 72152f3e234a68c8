#ifndef ELASTIMATE_CORE_MECHANICS_STRAIN_ENERGY_H_
#define ELASTIMATE_CORE_MECHANICS_STRAIN_ENERGY_H_

#include <Eigen/Core>

#include "elastimate/core/materials/elasticity.h"
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

/// Estimates the discretisation error of finite element displacements: the
/// strain energy that the elements miss over the energy that they have
/// [Zienkiewicz & Zhu, Int. J. Numer. Methods Eng. 24 (1987) 337, eq. 14],
///
///   integral of (e* - e):C:(e* - e) / integral of e:C:e,
///
/// where the recovered strain e* is linear between the vertices.  At each
/// vertex it is the mean of the strains of the elements around it, weighted by
/// their volumes.  At equal forces the real specimen moves further than its
/// elements do by about this share, so that a fit to its displacements gives a
/// Young's modulus that is too low by about the same share.  The estimate has
/// been half of the true error in coarse meshes of slender specimens, and three
/// times the true error in others.
///
/// `displacement` is num_dofs x num_load_cases; the energies of the load cases
/// are summed.  The result is zero without any strain.  Precondition: a valid
/// mesh.  Cost: two element passes.
[[nodiscard]] double DiscretizationError(const Mesh& mesh,
                                         const IsotropicElasticity& elasticity,
                                         const Eigen::MatrixXd& displacement);

}  // namespace elastimate

#endif  // ELASTIMATE_CORE_MECHANICS_STRAIN_ENERGY_H_
