#ifndef ELASTIMATE_ESTIMATORS_FORCE_BALANCE_VIRTUAL_WORK_CHECK_H_
#define ELASTIMATE_ESTIMATORS_FORCE_BALANCE_VIRTUAL_WORK_CHECK_H_

#include "elastimate/core/scene/scene.h"
#include "elastimate/estimators/interface/estimate.h"
#include "elastimate/estimators/interface/estimator.h"
#include "elastimate/estimators/interface/evidence.h"

namespace elastimate {

/// Whether noise explains the force residual of a usable `estimate`, which its
/// size does not tell: the stiffness matrix makes much of little noise.  The
/// virtual work of fields of degree 1 (VirtualFields), which sums the noise up,
/// tells.  Where it finds more than noise, its covariance is added to that of
/// the estimate; WorkCheck::kContradicts when virtual-fields is not usable.
///
/// Does nothing for a residual below a tenth of the load, and for laws of large
/// strains.  Cost: that of
/// virtual-fields of degree 1, which is added to the work of the estimate.
/// Preconditions: those of VirtualFields::Run.
WorkCheck CheckByVirtualWork(const Scene& scene,
                             const EstimatorOptions& options,
                             Estimate& estimate);

}  // namespace elastimate

#endif  // ELASTIMATE_ESTIMATORS_FORCE_BALANCE_VIRTUAL_WORK_CHECK_H_
