#ifndef ELASTIMATE_ESTIMATORS_FORCE_BALANCE_VIRTUAL_WORK_REGRESSION_H_
#define ELASTIMATE_ESTIMATORS_FORCE_BALANCE_VIRTUAL_WORK_REGRESSION_H_

#include <optional>

#include "elastimate/core/scene/scene.h"
#include "elastimate/estimators/force_balance/virtual_work.h"
#include "elastimate/estimators/force_balance/work_balance.h"
#include "elastimate/estimators/interface/estimate.h"
#include "elastimate/estimators/interface/estimator.h"
#include "elastimate/estimators/interface/free_parameters.h"
#include "elastimate/estimators/statistics/bounded_variables.h"

namespace elastimate {

/// The fields that virtual-fields takes for the materials of a scene:
/// polynomials over the whole specimen for one material, and for several
/// polynomials times the part of the volume around each node that a material
/// has, for each of them.  Their degree, unless options.virtual_field_degree
/// asks for another, is 2 for two parameters and for five materials or more,
/// else 3.
VirtualWork FieldsOfMaterials(const Scene& scene,
                              const EstimatorOptions& options);

/// The least of ||z||^2 of the balance over the variables, the best of what
/// Ceres finds from several starts: near nu = 1/2 the balance has other minima.
/// Empty where the displacements oppose the loads.
std::optional<BoundedMinimum> MinimizeWorkBalance(const FreeParameters& free,
                                                  int max_iterations,
                                                  const ForceResidual& forces,
                                                  WorkBalance& balance);

/// About where that minimum is, as a start of another method: by fields over
/// the whole of the specimen, or by few of each of five materials and more;
/// empty where there is none.  Adds its work.
std::optional<BoundedMinimum> MinimizeVirtualWork(
    const Scene& scene, const EstimatorOptions& options, Work& work);

}  // namespace elastimate

#endif  // ELASTIMATE_ESTIMATORS_FORCE_BALANCE_VIRTUAL_WORK_REGRESSION_H_
