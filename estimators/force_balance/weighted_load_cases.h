#ifndef ELASTIMATE_ESTIMATORS_FORCE_BALANCE_WEIGHTED_LOAD_CASES_H_
#define ELASTIMATE_ESTIMATORS_FORCE_BALANCE_WEIGHTED_LOAD_CASES_H_

#include <Eigen/Core>

#include "elastimate/core/scene/scene.h"

namespace elastimate {

// The methods without a finite element solution take all load cases at once,
// each divided by its noise_sd where that is given, so that the noise of the
// weighted displacements has standard deviation 1.

/// Measured displacements where the supports leave the nodes free, given ones
/// where they hold them: num_dofs x num_load_cases.
/// Precondition: every free component is observed.
Eigen::MatrixXd WeightedDisplacements(const Scene& scene);

/// The loads, num_dofs x num_load_cases.
Eigen::MatrixXd WeightedLoads(const Scene& scene);

}  // namespace elastimate

#endif  // ELASTIMATE_ESTIMATORS_FORCE_BALANCE_WEIGHTED_LOAD_CASES_H_
