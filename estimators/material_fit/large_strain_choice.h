#ifndef ELASTIMATE_ESTIMATORS_MATERIAL_FIT_LARGE_STRAIN_CHOICE_H_
#define ELASTIMATE_ESTIMATORS_MATERIAL_FIT_LARGE_STRAIN_CHOICE_H_

#include <string>
#include <vector>

#include "elastimate/core/scene/scene.h"
#include "elastimate/estimators/interface/estimate.h"
#include "elastimate/estimators/interface/estimator.h"

namespace elastimate {

/// Returns the materials with their law replaced by `law`; an empty list
/// becomes one material of this law.
[[nodiscard]] std::vector<Material> MaterialsOfLargeStrains(
    std::vector<Material> materials, const std::string& law);

/// Tells whether laws of large strains are to be fitted in place of isotropic
/// ones.  The options decide if they ask for small or large kinematics.  If
/// they leave it open, it is true for measured displacements of isotropic
/// materials, if strains or rotations are large enough to be mentioned
/// (IsMentioned) and are possible (IsPossible).
[[nodiscard]] bool AsksForLargeStrains(const Scene& scene,
                                       const EstimatorOptions& options);

/// Fits laws of large strains in place of isotropic ones (FitMaterials).
///
/// The corotated law is fitted first, because it differs from small strains by
/// rotations alone.  If strains exceed half of the size that is mentioned, the
/// neo-Hookean and the St Venant-Kirchhoff law are fitted as well, starting at
/// the parameters of the corotated fit.  The likelihoods are compared,
///
///   chi^2_i - chi^2_best = n ln(RSS_i / RSS_best),
///
/// for n rows of displacements and the sum of squared residuals RSS of each
/// law.  The best law is reported (Estimate::large_strain_law).  Other laws
/// whose difference d is below 9 explain the data about as well.  Each of them
/// has the weight exp(-d / 2), and the weighted mean square of the distances
/// between their parameters and those of the best law is added to the
/// covariance (ErrorBudget::law).  The specimen may follow none of these laws.
/// So for measured displacements, ErrorBudget::law is at least half of the
/// distance to the nearest other law.
///
/// The laws are compared on quadratic elements of the mesh.  Only the best law
/// is fitted on the divided mesh as well.
///
/// Preconditions: those of FitMaterials; the materials are isotropic.  Cost:
/// one to four fits.
[[nodiscard]] Estimate FitLargeStrainLaws(const Scene& scene,
                                          const EstimatorOptions& options);

}  // namespace elastimate

#endif  // ELASTIMATE_ESTIMATORS_MATERIAL_FIT_LARGE_STRAIN_CHOICE_H_
