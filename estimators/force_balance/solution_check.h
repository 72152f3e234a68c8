#ifndef ELASTIMATE_ESTIMATORS_FORCE_BALANCE_SOLUTION_CHECK_H_
#define ELASTIMATE_ESTIMATORS_FORCE_BALANCE_SOLUTION_CHECK_H_

#include "elastimate/core/scene/scene.h"
#include "elastimate/estimators/interface/estimate.h"
#include "elastimate/estimators/interface/estimator.h"
#include "elastimate/estimators/interface/evidence.h"
#include "elastimate/estimators/misfit/observed_model.h"

namespace elastimate {

/// Holds an estimate x = (ln E, nu) of one isotropic material by virtual work
/// against the measured displacements, which no virtual field weighs here: the
/// model is solved at x, and the step
///
///   d = -(S^T S)^-1 S^T (u - q) + c
///
/// to the least misfit of u + S d, corrected by c for what finer elements
/// change (ElementErrors), or that of a model linear in 1 / E and in
/// ln((1 + nu) / (1 - 2 nu)) where it is larger, is what x may be off by [the
/// difference of an efficient and a robust estimate: Hausman, Econometrica 46
/// (1978) 1251]. Adds to its covariance
///
///   alpha d d^T + (1 - alpha) d d^T / 1.96^2 + C',
///
/// where alpha is the share of the change that is there: then d is what the
/// elements do to virtual work, else it is mostly noise, and the minimum lies
/// within each interval.  C' is what that is uncertain by beside noise.
///
/// Cost: a factorisation, a solve for each load case and parameter, and those
/// of ElementChange.
/// Preconditions: the scene is that of the model, held, and observed in all
/// free components; the estimate is usable and has its covariance.
void CheckBySolution(const Scene& scene, const EstimatorOptions& options,
                     ObservedModel& model, Evidence& evidence,
                     Estimate& estimate);

}  // namespace elastimate

#endif  // ELASTIMATE_ESTIMATORS_FORCE_BALANCE_SOLUTION_CHECK_H_
