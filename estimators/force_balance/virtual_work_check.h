#ifndef ELASTIMATE_ESTIMATORS_FORCE_BALANCE_VIRTUAL_WORK_CHECK_H_
#define ELASTIMATE_ESTIMATORS_FORCE_BALANCE_VIRTUAL_WORK_CHECK_H_

#include <Eigen/Core>

#include "elastimate/core/scene/scene.h"
#include "elastimate/estimators/force_balance/force_residual.h"
#include "elastimate/estimators/interface/estimate.h"
#include "elastimate/estimators/interface/estimator.h"
#include "elastimate/estimators/interface/evidence.h"
#include "elastimate/estimators/interface/free_parameters.h"

namespace elastimate {

/// Whether noise explains the force residual of a usable `estimate`, which its
/// size does not tell: the stiffness matrix makes much of little noise.  The
/// virtual work of fields of degree 1 (VirtualFields), which sums the noise up,
/// tells.  Where it finds more than noise, its covariance is added to that of
/// the estimate; WorkCheck::kContradicts when virtual-fields is not usable.
///
/// Does nothing for a residual below a tenth of the load.  Cost: that of
/// virtual-fields of degree 1, which is added to the work of the estimate.
/// Preconditions: those of VirtualFields::Run.
WorkCheck CheckByVirtualWork(const Scene& scene,
                             const EstimatorOptions& options,
                             Estimate& estimate);

/// Does what CheckByVirtualWork does for laws of large strains, whose tangents
/// K_c at the measured q differ between load cases c.  With the same fields V
/// and L_c L_c^T = V^T K_c K_c V, noise of variance sigma^2 makes
///
///   z_c = L_c^-1 V^T (F_c theta - f_c)
///
/// of covariance sigma^2.  With D = dz / dx, what changes of the variables x
/// cannot explain, z - D D^+ z, tells whether there is more than noise of this
/// variance.  Then |z - D D^+ z|^2 (D^T D)^-1 is added to the covariance of the
/// variables.
/// Cost: an element pass for each load case.
WorkCheck CheckByLargeVirtualWork(const Scene& scene,
                                  const FreeParameters& free,
                                  const Eigen::VectorXd& variables,
                                  double noise_variance,
                                  const ForceResidual& forces,
                                  Estimate& estimate);

}  // namespace elastimate

#endif  // ELASTIMATE_ESTIMATORS_FORCE_BALANCE_VIRTUAL_WORK_CHECK_H_
