#ifndef ELASTIMATE_ESTIMATORS_FORCE_BALANCE_VIRTUAL_WORK_REGRESSION_H_
#define ELASTIMATE_ESTIMATORS_FORCE_BALANCE_VIRTUAL_WORK_REGRESSION_H_

#include <optional>

#include "elastimate/core/scene/scene.h"
#include "elastimate/estimators/interface/estimate.h"
#include "elastimate/estimators/interface/estimator.h"
#include "elastimate/estimators/statistics/bounded_variables.h"

namespace elastimate {

/// The parameters of any materials from the balance of virtual work of
/// polynomial fields V (VirtualWork), of several materials times the part of
/// the volume around each node that a material has, for each of them, of degree
/// 3 unless another is asked for, from five materials on of degree 2, weighted
/// by its own covariance:
///
///   min S = r^T G^-1 r,   r = V^T (F(q) theta - f),   G = M^T M,
///   M = K(theta) V on the free rows.
///
/// With lambda = G^-1 r and the corrected displacements q - M lambda, the
/// derivative of L^-1 r (G = L L^T) is taken as
/// L^-1 V^T f_k(q - M lambda), which makes that of S exact.  Under noise of q
/// of variance sigma^2, the covariance of theta is sigma^2 (D^T G^-1 D)^-1 with
/// D = V^T f_k(q - M lambda).
///
/// Nothing here sees whether the regions are right and what the elements miss.
///
/// Preconditions are those of Estimator::Run; every free component is observed.
/// Cost: in each step an element pass of as many columns as there are fields
/// (60 for each material in three dimensions, 20 in two; 30 or 12 of five
/// materials and more), and their QR factorisation.
Estimate BalanceVirtualWork(const Scene& scene,
                            const EstimatorOptions& options);

/// About where the minimum of S is, as a start: by fields over the whole
/// of the specimen, or by few of each of five materials and more; empty where
/// there is none.  Adds its work.
std::optional<BoundedMinimum> MinimizeVirtualWork(
    const Scene& scene, const EstimatorOptions& options, Work& work);

}  // namespace elastimate

#endif  // ELASTIMATE_ESTIMATORS_FORCE_BALANCE_VIRTUAL_WORK_REGRESSION_H_
