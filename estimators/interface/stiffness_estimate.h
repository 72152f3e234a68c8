#ifndef ELASTIMATE_ESTIMATORS_INTERFACE_STIFFNESS_ESTIMATE_H_
#define ELASTIMATE_ESTIMATORS_INTERFACE_STIFFNESS_ESTIMATE_H_

#include <vector>

#include "elastimate/core/scene/scene.h"
#include "elastimate/estimators/interface/estimate.h"

namespace elastimate {

/// The stiffness of each material that is not isotropic, from the parameters of
/// the estimate and their covariance C by the delta method: its entries are
/// linear in the moduli, whose covariance is J C J^T, J = d theta / d p.
/// Empty without parameters.
std::vector<StiffnessEstimate> StiffnessesOf(const Scene& scene,
                                             const Estimate& estimate);

/// Whether all its eigenvalues are positive.
bool IsPositiveDefinite(const StiffnessEstimate& stiffness);

}  // namespace elastimate

#endif  // ELASTIMATE_ESTIMATORS_INTERFACE_STIFFNESS_ESTIMATE_H_
