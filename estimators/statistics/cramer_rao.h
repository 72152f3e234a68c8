#ifndef ELASTIMATE_ESTIMATORS_STATISTICS_CRAMER_RAO_H_
#define ELASTIMATE_ESTIMATORS_STATISTICS_CRAMER_RAO_H_

#include <Eigen/Core>

#include "elastimate/core/materials/elasticity.h"
#include "elastimate/core/scene/scene.h"

namespace elastimate {

/// The Cramer-Rao bound: no unbiased estimator of (E, nu) from displacements
/// with independent Gaussian noise of standard deviation sigma has a smaller
/// covariance than
///
///   C = (sum over the observed free components of s s^T / sigma^2)^-1,
///
/// with s = du / d (E, nu) at the true parameters [Rao 1945, Cramer 1946].
/// C(0, 0) is that of E when nu is estimated as well; with a known nu, E has
/// the bound C(0, 0) - C(0, 1)^2 / C(1, 1).
///
/// `noise_sd` holds sigma for each load case [length]; which components are
/// observed is taken from the scene, whose measured displacements are not
/// looked at.  Infinite where the data do not determine the parameters.
/// Throws std::invalid_argument for an invalid scene, parameters that are not
/// physical, supports that do not hold the specimen, or a noise_sd that is not
/// positive for each load case; std::runtime_error when the stiffness is
/// singular to working precision.
/// Cost: one factorisation and two solves for each load case.
[[nodiscard]] Eigen::Matrix2d CramerRaoBound(
    const Scene& scene, const IsotropicElasticity& elasticity,
    const Eigen::VectorXd& noise_sd);

}  // namespace elastimate

#endif  // ELASTIMATE_ESTIMATORS_STATISTICS_CRAMER_RAO_H_
