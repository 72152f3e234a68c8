#ifndef ELASTIMATE_ESTIMATORS_MATERIAL_FIT_LAW_CHOICE_H_
#define ELASTIMATE_ESTIMATORS_MATERIAL_FIT_LAW_CHOICE_H_

#include <string>
#include <vector>

#include "elastimate/core/scene/scene.h"
#include "elastimate/estimators/interface/estimate.h"
#include "elastimate/estimators/interface/estimator.h"

namespace elastimate {

/// The law that a measurement asks for.
struct ChosenLaw {
  /// The materials of the scene, with the law that was chosen.
  std::vector<Material> materials;
  /// What was compared, the best first.
  std::vector<LawComparison> laws;
  /// Why nothing could be compared; empty where it was.
  std::string why_not;
  Work work;
};

/// Why laws of a scene cannot be compared, and what to do; empty when they can:
/// it is one in three dimensions, nothing is known of its materials, and their
/// axes, if there are any, are the same in all elements.
std::string WhyNoLawChoice(const Scene& scene, const EstimatorOptions& options);

/// Chooses the law of all materials of a scene, of isotropic, transversely
/// isotropic (about the axis of each material that has one, else about one that
/// is to be found), orthotropic (where each material has two axes) and
/// anisotropic, by the Bayesian information criterion
///
///   min_p (theta(p) - theta)^T C^-1 (theta(p) - theta) + k ln n,
///
/// in which theta are the 21 stiffnesses of each material in a fit of no
/// symmetry, C is their covariance by noise, model and elements, k the number
/// of parameters p of the law, and n that of observed components [Schwarz, Ann.
/// Statist. 6 (1978) 461; chi^2 of Wald instead of the likelihood, so that one
/// fit serves all laws].  Where no noise is given, that of each load case is
/// what the fit leaves of it: load cases of unequal noise count by their own.
///
/// Preconditions are those of FitMaterials, and no WhyNoLawChoice.  Cost: a fit
/// of 21 parameters for each material, two for several load cases.
ChosenLaw ChooseLaw(const Scene& scene, const EstimatorOptions& options);

/// Enters what was compared into the estimate of the chosen law.
void EnterLawChoice(const ChosenLaw& choice, Estimate& estimate);

}  // namespace elastimate

#endif  // ELASTIMATE_ESTIMATORS_MATERIAL_FIT_LAW_CHOICE_H_
