#ifndef ELASTIMATE_ESTIMATORS_MATERIAL_FIT_SMALL_STRAIN_START_H_
#define ELASTIMATE_ESTIMATORS_MATERIAL_FIT_SMALL_STRAIN_START_H_

#include <Eigen/Core>
#include <optional>

#include "elastimate/core/scene/scene.h"
#include "elastimate/core/solvers/stiffness_solver.h"
#include "elastimate/estimators/interface/estimator.h"
#include "elastimate/estimators/misfit/displacement_misfit.h"

namespace elastimate {

/// The variables from which a fit of materials of large strains starts: typical
/// values, the free moduli of each material multiplied by a factor of its own,
/// by which isotropic materials of small strains, of the Poisson's ratios that
/// typical values have at rest, explain the displacements best.  In a bent
/// specimen that factor is too large by about half of the square of the
/// rotation, which Poisson's ratio would not survive.  Where the model has no
/// stable equilibrium there, all free moduli are doubled until it has one.
/// Without loads, resultants give one factor for all.
///
/// Empty where displacements oppose the loads, and where no equilibrium is
/// found.  A factorisation of small strains for one material, some for several,
/// and one Solve of the model, the result of which stays in `misfit`.  The work
/// of small strains is added to `work`.
std::optional<Eigen::VectorXd> SmallStrainStart(const Scene& scene,
                                                const EstimatorOptions& options,
                                                DisplacementMisfit& misfit,
                                                Work& work);

}  // namespace elastimate

#endif  // ELASTIMATE_ESTIMATORS_MATERIAL_FIT_SMALL_STRAIN_START_H_
