#ifndef ELASTIMATE_ESTIMATORS_MATERIAL_FIT_REDUCED_DESCENT_H_
#define ELASTIMATE_ESTIMATORS_MATERIAL_FIT_REDUCED_DESCENT_H_

#include <Eigen/Core>
#include <optional>
#include <vector>

#include "elastimate/core/scene/scene.h"
#include "elastimate/estimators/interface/estimate.h"
#include "elastimate/estimators/misfit/displacement_misfit.h"
#include "elastimate/estimators/statistics/bounded_variables.h"

namespace elastimate {

/// The minimum of a misfit within bounds by reduced models
/// (ReducedEquilibrium), with few factorisations: from the bases {u, du/dx} at
/// a pole,
///
///   1. the minimum x of the reduced model, where no modulus is more than ten
///      times that of the pole, and no ratio more than nine tenths of the way
///      to an end of the range of its law that is not near,
///   2. u and the adjoint lambda = K^-1 P^T (P u - q) of the full model at x,
///      by conjugate gradients with the factor of the pole (SolveNearby), and
///      from them the gradient g of the full misfit at x,
///   3. where the Gauss-Newton step d = -G^+ g, G = S^T S, on the variables
///      that g does not hold on a bound, is below a twentieth of the standard
///      error in every direction, sqrt(g^T G^+ g) < sigma / 20, x is the
///      minimum: the end is kDone;
///   4. else u and lambda go into the bases, with which the reduced misfit and
///      its gradient are those of the full model at x, and 1 follows; or x
///      becomes the next pole, where it is far from the last one or the steps
///      do not halve.
///
/// The end is kNotCertified where ten poles, or options.max_iterations, do not
/// lead there.  What it says is that x is a minimum, not that there is no other
/// one far away.  The misfit is
/// left with u and du/dx at the minimum, by conjugate gradients too, to 1e-4
/// of their energy norms.
///
/// The first pole is at `start`, else at typical values (TypicalStart).  Empty
/// where displacements oppose the loads.  Adds the work that the equilibrium
/// does not count to the estimate.
///
/// Precondition: no unknown motions.  Cost: 1 to 3 factorisations and, for each
/// load case and pole, a solve for each variable; and about five times as many
/// element passes; over coarser spaces instead of a factor, about fifty for
/// each of these solves.  Memory: some 6 vectors for each load case and
/// variable.
std::optional<BoundedMinimum> ReducedMinimum(
    const std::optional<Eigen::VectorXd>& start,
    const EstimatorOptions& options, DisplacementMisfit& misfit,
    Estimate& estimate);

/// Returns the starts of a fit of materials whose axis is to be found, the best
/// first: the misfit has a minimum near several axes.  The model is reduced to
/// u and its derivatives by all moduli, so to those of every axis, at typical
/// values that are alike in all directions.  Descents of this reduced model
/// start along 13 axes over a half sphere.  Returned are the minima they lead
/// to that are apart and nearly as probable as the least one.  Where motions
/// are unknown, these are typical values along each axis.  Empty where
/// displacements oppose the loads.  Cost: two factorisations and a solve for
/// each modulus.
[[nodiscard]] std::vector<Eigen::VectorXd> StartsOverAxes(
    const Scene& scene, DisplacementMisfit& misfit);

}  // namespace elastimate

#endif  // ELASTIMATE_ESTIMATORS_MATERIAL_FIT_REDUCED_DESCENT_H_
