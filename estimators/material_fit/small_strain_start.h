#ifndef ELASTIMATE_ESTIMATORS_MATERIAL_FIT_SMALL_STRAIN_START_H_
#define ELASTIMATE_ESTIMATORS_MATERIAL_FIT_SMALL_STRAIN_START_H_

#include <Eigen/Core>
#include <optional>

#include "elastimate/core/scene/scene.h"
#include "elastimate/core/solvers/stiffness_solver.h"
#include "elastimate/estimators/interface/estimator.h"
#include "elastimate/estimators/misfit/displacement_misfit.h"

namespace elastimate {

/// Returns the variables at which a fit of materials of large strains starts.
/// They are typical values of the parameters, but the free moduli of each
/// material are multiplied by a factor.
///
/// The factors come from a fit of isotropic materials of small strains.  Their
/// Poisson's ratios are fixed at those of the typical values at rest: a bent
/// specimen makes the factor too large by about half of the square of the
/// rotation [rad], but would make a fitted Poisson's ratio useless.  The values
/// are stiffened (StiffenedStart).  If the scene has no loads but resultants,
/// these give one factor for all materials.
///
/// Returns nothing if the displacements oppose the loads, or if no equilibrium
/// is found.  Cost: one factorisation of small strains for one material, some
/// for several, and a Solve of the model for each attempt; the result of the
/// last Solve stays in `misfit`.  The work of small strains is added to `work`.
std::optional<Eigen::VectorXd> SmallStrainStart(const Scene& scene,
                                                const EstimatorOptions& options,
                                                DisplacementMisfit& misfit,
                                                Work& work);

/// Returns `variables` with all free moduli doubled until the model has a
/// stable equilibrium, which quadratic elements may not have at the minimum of
/// stiffer linear ones.  Returns nothing if six times are not enough.  Cost: a
/// Solve for each attempt.
std::optional<Eigen::VectorXd> StiffenedStart(const Eigen::VectorXd& variables,
                                              DisplacementMisfit& misfit);

}  // namespace elastimate

#endif  // ELASTIMATE_ESTIMATORS_MATERIAL_FIT_SMALL_STRAIN_START_H_
