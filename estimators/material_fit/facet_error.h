#ifndef ELASTIMATE_ESTIMATORS_MATERIAL_FIT_FACET_ERROR_H_
#define ELASTIMATE_ESTIMATORS_MATERIAL_FIT_FACET_ERROR_H_

#include <Eigen/Core>
#include <optional>

#include "elastimate/core/scene/scene.h"
#include "elastimate/estimators/interface/estimate.h"

namespace elastimate {

/// The relative error of all moduli by flat facets of a specimen whose surface
/// is smooth, where the forces on it are given, to first order,
///
///   integral over the surface of h w / integral over the volume of w,
///
/// where h is how far the smooth surface lies outside the facets
/// (BulgeOfFacets), and w the energy density of the fitted displacement,
/// num_dofs x num_load_cases, summed over the load cases.  It is positive where
/// the mesh is too slender, so that the moduli come out too large.
///
/// Empty for curved elements, for laws of large strains, for tractions,
/// pressures and body forces, which act on the area or the volume of the mesh,
/// and where there is no energy.  Precondition: the estimate has finite
/// parameters of the scene. O(num_elements).
[[nodiscard]] std::optional<double> ErrorByFacets(
    const Scene& scene, const Estimate& estimate,
    const Eigen::MatrixXd& displacement);

/// Warns where a usable estimate of a measured specimen would have an error by
/// its facets that is notable, and larger than the standard error of the best
/// known modulus, which may be the shear modulus.
void WarnOfFlatFacets(const Scene& scene, const Eigen::MatrixXd& displacement,
                      Estimate& estimate);

}  // namespace elastimate

#endif  // ELASTIMATE_ESTIMATORS_MATERIAL_FIT_FACET_ERROR_H_
