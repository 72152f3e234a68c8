#ifndef ELASTIMATE_ESTIMATORS_MAPS_LEVEL_FIT_H_
#define ELASTIMATE_ESTIMATORS_MAPS_LEVEL_FIT_H_

#include <Eigen/Core>
#include <limits>
#include <optional>
#include <vector>

#include "elastimate/estimators/maps/map_problem.h"

namespace elastimate {

/// Returns the indicator of each part: num_elements x num_parts.
[[nodiscard]] Eigen::MatrixXd PartsOf(const std::vector<int>& part_of_element,
                                      Eigen::Index num_parts);

/// A fit of one modulus for each part of a body, and one nu.
struct LevelFit {
  Eigen::VectorXd levels;  ///< ln E of each part.
  MapState state;
  double square_sum;  ///< Of the rows that are left.
  FlatUnknowns unknowns;
};

/// Fits ln E of each part and nu, which regions with their own nu
/// (FitMaterials) are not: Gauss-Newton with backtracking from `start` on,
/// whose moduli are equal within each part.  The model is at the fit
/// afterwards.  A solve for each part and load case in each of some five steps.
/// Empty where the stiffness is singular at the start, and where the model that
/// is linearised there leaves more than `most` of the square sum, which one
/// factorisation tells.
[[nodiscard]] std::optional<LevelFit> FitLevels(
    const MapProblem& problem, const std::vector<int>& part_of_element,
    const Eigen::VectorXd& levels, double poisson_ratio,
    double most = std::numeric_limits<double>::infinity());

}  // namespace elastimate

#endif  // ELASTIMATE_ESTIMATORS_MAPS_LEVEL_FIT_H_
