#ifndef ELASTIMATE_ESTIMATORS_MISFIT_MATERIAL_VERDICTS_H_
#define ELASTIMATE_ESTIMATORS_MISFIT_MATERIAL_VERDICTS_H_

#include <Eigen/Core>
#include <string>
#include <vector>

#include "elastimate/core/scene/scene.h"
#include "elastimate/estimators/interface/estimate.h"
#include "elastimate/estimators/misfit/displacement_misfit.h"
#include "elastimate/estimators/misfit/minimum_statistics.h"

namespace elastimate {

/// Enters what a fit says of each of several materials, and of combinations of
/// their parameters, into the estimate, whose parameters are entered:
///
/// - its part of the strain energy, sum over its moduli of theta_k u . f_k(u)
///   over that of all;
/// - the mean square of the residuals of its nodes and points over that of the
///   noise, and the correlation of neighbours among them: where that is more
///   than noise leaves, the material may not be the same all over its regions;
/// - DeterminedCombinations.
///
/// Nothing for one material.  Precondition: the misfit is at the minimum of
/// these errors.  A pass for each load case, and O(num_materials (num_pairs +
/// num_rows)).
void DescribeMaterials(const Scene& scene, const MinimumErrors& errors,
                       DisplacementMisfit& misfit, Estimate& estimate);

/// In words, such as "the product of E of region 2 and E of region 3", the
/// combinations of variables that are determined where none of these is alone,
/// but each would be if the others were known: where C_ii > 1 > 1 / (C^-1)_ii
/// of the covariance C in units of the errors up to which they are determined.
/// Of these variables, C has eigenvectors of variances above 1, which are not
/// determined; those that take part in the same ones belong together.
///
/// `labels` of the variables; `is_logarithm` of which are those of moduli.
/// O(num_variables^3).
std::vector<std::string> DeterminedCombinations(
    const Eigen::MatrixXd& covariance, const Eigen::VectorXd& largest_errors,
    const std::vector<std::string>& labels,
    const std::vector<bool>& is_logarithm);

}  // namespace elastimate

#endif  // ELASTIMATE_ESTIMATORS_MISFIT_MATERIAL_VERDICTS_H_
