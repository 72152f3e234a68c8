#ifndef ELASTIMATE_CORE_MECHANICS_STRAIN_ENERGY_H_
#define ELASTIMATE_CORE_MECHANICS_STRAIN_ENERGY_H_

#include <Eigen/Core>

#include "elastimate/core/materials/elasticity.h"
#include "elastimate/core/mesh/mesh.h"

namespace elastimate {

/// Strain energy per volume of each element,
/// mu e:e + (lambda / 2) tr(e)^2 [energy / length^3], num_elements values; its
/// mean where the strain e varies.  lambda is 2 lambda mu / (lambda + 2 mu) in
/// plane stress.  `displacement` is dimension x num_nodes.  Precondition: a
/// valid mesh. Cost: one element pass.
[[nodiscard]] Eigen::VectorXd StrainEnergyDensity(
    const Mesh& mesh, const IsotropicElasticity& elasticity,
    const Eigen::MatrixXd& displacement);

/// The discretisation error of finite element displacements: the strain energy
/// that the elements miss, relative to theirs, as Zienkiewicz & Zhu estimate it
/// [Int. J. Numer. Methods Eng. 24 (1987) 337, eq. 14],
///
///   integral of (e* - e):C:(e* - e) / integral of e:C:e,
///
/// where the recovered strain e* is linear between the vertices, and at each
/// the mean of the strains of the elements around it, weighted by their
/// volumes.  At equal forces the specimen that the elements stand for moves
/// further by about this share, so that Young's modulus of a fit to its
/// displacements is too low by about it; in coarse meshes of slender specimens
/// the estimate has been half, in others three times the true error.
///
/// `displacement` is num_dofs x num_load_cases, whose energies are summed.
/// Zero without any strain.  Precondition: a valid mesh.
/// Cost: two element passes.
[[nodiscard]] double DiscretizationError(const Mesh& mesh,
                                         const IsotropicElasticity& elasticity,
                                         const Eigen::MatrixXd& displacement);

}  // namespace elastimate

#endif  // ELASTIMATE_CORE_MECHANICS_STRAIN_ENERGY_H_
