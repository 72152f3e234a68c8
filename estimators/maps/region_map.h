#ifndef ELASTIMATE_ESTIMATORS_MAPS_REGION_MAP_H_
#define ELASTIMATE_ESTIMATORS_MAPS_REGION_MAP_H_

#include <Eigen/Core>
#include <vector>

#include "elastimate/estimators/maps/field_prior.h"
#include "elastimate/estimators/maps/level_fit.h"
#include "elastimate/estimators/maps/map_problem.h"

namespace elastimate {

/// Regions of one modulus each, in the order of their moduli.
struct RegionMap {
  std::vector<int> region_of_element;
  LevelFit fit;
  /// ln B over a homogeneous body.
  double log_evidence = 0;
  /// The covariance of ln E of each region and, in the last row and column, of
  /// the LogStiffnessRatio of nu: sigma^2 (Z^T Z)^-1 by noise, and what
  /// elements add whose region is not certain.
  Eigen::MatrixXd covariance;
  double variance = 0;  ///< sigma^2 of a row.
};

/// Divides a body into regions by a sharpened map.  Two and then three means of
/// ln E (by volume) are the start.  Then elements at the boundary of a region
/// go to the one on the other side where that is worth it,
///
///   g delta + h delta^2 / 2 + change of the number of facets < 0,
///
/// with g the gradient and h the curvature of |r|^2 / (2 sigma^2) by ln E of
/// the element and delta its change.  Many elements move at a time: shares of
/// all such moves, from 0 to 1, minimise the misfit of the linearised model and
/// the growth of the boundaries, and moves with a share above one half are
/// made, or the first half of these, a quarter, and so on.  Where none of that
/// is better, moves that gain by themselves are tried likewise.  The moduli are
/// fitted again after each trial.  Such rounds go on as long as
///
///   BIC = N ln |r|^2 + k ln N + 2 (facets between regions)
///
/// falls, with |r|^2 / sigma^2 for the first term where sigma is known. Returns
/// the better map of k = 2 and k = 3 and, behind one of three regions, that of
/// two.  Maps are left out that could not be fitted, or where sigma is not
/// known and there are fewer than three rows for each unknown.  Cost of each of
/// at most 15 rounds: a solve for each element for which g delta + change < 0,
/// the best 1000 moves at most, and some fits of levels; memory for num_rows
/// numbers of each of these elements. The errors take one more such search, of
/// elements with g delta + change < 6.
[[nodiscard]] std::vector<RegionMap> FitRegions(const MapProblem& problem,
                                                const FieldPrior& prior,
                                                const MapState& sharpened,
                                                const LevelFit& homogeneous);

}  // namespace elastimate

#endif  // ELASTIMATE_ESTIMATORS_MAPS_REGION_MAP_H_
