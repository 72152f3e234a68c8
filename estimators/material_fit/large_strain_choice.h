#ifndef ELASTIMATE_ESTIMATORS_MATERIAL_FIT_LARGE_STRAIN_CHOICE_H_
#define ELASTIMATE_ESTIMATORS_MATERIAL_FIT_LARGE_STRAIN_CHOICE_H_

#include <string>
#include <vector>

#include "elastimate/core/scene/scene.h"
#include "elastimate/estimators/interface/estimate.h"
#include "elastimate/estimators/interface/estimator.h"

namespace elastimate {

/// Returns the materials with this law in place of the isotropic one; an empty
/// list becomes one material.
[[nodiscard]] std::vector<Material> MaterialsOfLargeStrains(
    std::vector<Material> materials, const std::string& law);

/// Tells whether laws of large strains are to be fitted in place of isotropic
/// ones: where the options say so, and where they leave it open, displacements
/// were measured, and strains or rotations are mentioned (IsMentioned).
[[nodiscard]] bool AsksForLargeStrains(const Scene& scene,
                                       const EstimatorOptions& options);

/// Fits laws of large strains in place of isotropic ones (FitMaterials).
///
/// The first is the corotated one, which differs from small strains by
/// rotations alone.  Where strains exceed half of what is mentioned, the
/// neo-Hookean law and that of St Venant and Kirchhoff are fitted as well, from
/// there, and the likelihoods are compared,
///
///   chi^2_i - chi^2_best = n ln(RSS_i / RSS_best),
///
/// for n rows of displacements and the square sum RSS that each law leaves of
/// them.  The best one is reported (Estimate::large_strain_law).  Others whose
/// difference d is below 9 explain the data about as well.  Each law has the
/// weight exp(-d / 2), and the mean square of the distances of the parameters
/// from those of the best is added to their covariance (ErrorBudget::law).  Of
/// measured displacements, the error by the law is half of the distance from
/// the nearest other law at least, since the specimen may follow none of them.
///
/// The laws are compared on quadratic elements of the mesh, which is divided
/// for the best alone.
///
/// Preconditions: those of FitMaterials; the materials are isotropic.  Cost:
/// one to four fits.
[[nodiscard]] Estimate FitLargeStrainLaws(const Scene& scene,
                                          const EstimatorOptions& options);

}  // namespace elastimate

#endif  // ELASTIMATE_ESTIMATORS_MATERIAL_FIT_LARGE_STRAIN_CHOICE_H_
