#ifndef ELASTIMATE_ESTIMATORS_MATERIAL_FIT_MATERIAL_DESCENT_H_
#define ELASTIMATE_ESTIMATORS_MATERIAL_FIT_MATERIAL_DESCENT_H_

#include <Eigen/Core>
#include <optional>
#include <vector>

#include "elastimate/core/scene/scene.h"
#include "elastimate/estimators/interface/estimate.h"
#include "elastimate/estimators/interface/estimator.h"
#include "elastimate/estimators/misfit/descent.h"
#include "elastimate/estimators/misfit/displacement_misfit.h"
#include "elastimate/estimators/statistics/bounded_variables.h"

namespace elastimate {

/// Typical values, the free moduli of the scale at which displacements fit best
/// when all moduli have it, also the known ones: what is known of a part may be
/// far from the rest, as of steel beside a soft tissue.  Where displacements
/// oppose the loads, or there are none, of the scale of the known modulus;
/// empty where none is known.  The model is left solved at typical values of
/// the scale 1, or of the known modulus, a factorisation.
std::optional<Eigen::VectorXd> TypicalStart(DisplacementMisfit& misfit);

/// The best start with a loss where one isotropic material has several nu to
/// choose from: that of the least absolute deviations, of which outliers, which
/// could turn a least-squares fit around, say little.  Empty for others.
std::optional<Eigen::VectorXd> RobustStart(const Scene& scene, Loss loss,
                                           DisplacementMisfit& misfit);

/// The variables from which descents lead to each minimum, other than the known
/// one, that 7 values of Poisson's ratio of one isotropic material show; empty
/// for other materials.  They are closer to each other below zero than those
/// from which a fit starts, as plates that bend have minima at nu and -nu.
std::vector<Eigen::VectorXd> StartsAcrossRange(const Scene& scene,
                                               const BoundedMinimum& known,
                                               DisplacementMisfit& misfit);

/// The variables that virtual-fields comes to; empty where it does not take the
/// scene, or they are not physical.  Adds its work to the estimate.
std::optional<Eigen::VectorXd> VirtualFieldsStart(
    const Scene& scene, const EstimatorOptions& options, Estimate& estimate);

/// The best of those that typical values and virtual-fields lead to; empty
/// where both oppose the loads.  Adds the work of virtual-fields to the
/// estimate.
std::optional<BoundedMinimum> BestMinimum(const Scene& scene,
                                          const EstimatorOptions& options,
                                          DisplacementMisfit& misfit,
                                          Estimate& estimate);

}  // namespace elastimate

#endif  // ELASTIMATE_ESTIMATORS_MATERIAL_FIT_MATERIAL_DESCENT_H_
