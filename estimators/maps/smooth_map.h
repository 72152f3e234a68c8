#ifndef ELASTIMATE_ESTIMATORS_MAPS_SMOOTH_MAP_H_
#define ELASTIMATE_ESTIMATORS_MAPS_SMOOTH_MAP_H_

#include <Eigen/Core>

#include "elastimate/estimators/maps/curvature_modes.h"
#include "elastimate/estimators/maps/field_prior.h"
#include "elastimate/estimators/maps/level_fit.h"
#include "elastimate/estimators/maps/map_problem.h"

namespace elastimate {

/// A smooth field that fits the measurement.
struct SmoothMap {
  MapState state;
  Eigen::VectorXd y;    ///< Of the FieldPrior, up to the level.
  double ratio = 0;     ///< k = tau^2 / sigma^2.
  double variance = 0;  ///< sigma^2 of a row.
  double square_sum = 0;
  /// gamma = tr(k H (I + k H)^-1): how many parameters the data support beside
  /// the level.
  double effective_number = 0;
  /// ln B: the logarithm of the evidence over that of a homogeneous body.
  double log_evidence = 0;
  bool has_converged = false;
  CurvatureModes modes;  ///< Of H at the state.
};

/// Returns the operator H = A^T S^T Pi S A.  It asks the model each time, which
/// must stay at the state of `unknowns`.  All arguments must outlive it.
[[nodiscard]] ColumnOperator CurvatureOf(const MapProblem& problem,
                                         const FieldPrior& prior,
                                         const FlatUnknowns& unknowns);

/// Fits the field of the FieldPrior and the flat unknowns (level of ln E, nu)
/// from the fit of a homogeneous body on.  Gauss-Newton steps solve
///
///   (I / k + H) delta = A^T S^T Pi r - y / k,   y <- y + delta,
///
/// for the residual r, by conjugate gradients with CurvatureModes for a
/// preconditioner.  Nothing is to be chosen: k is where the evidence is
/// greatest,
///
///   -2 ln ev = (N - p) ln q + ln det(I + k H),   sigma^2 = q / (N - p),
///   q = min over delta of |Pi (r - S A delta)|^2 + |y + delta|^2 / k,
///
/// with q / sigma^2 for the first term where sigma is known, N rows and p flat
/// unknowns; gamma is at most (N - p) / 3, or twice that where sigma is known,
/// lest noise pass for structure.  The evidence as a function of k is computed
/// from the modes and, beside them, from LanczosSums.  Cost: a factorisation
/// and some hundred solves for each of about six steps, and a solve for each
/// mode, many columns at a time, each time the modes are renewed (two or three
/// times); memory for three numbers of each element and mode, at most 0.8 GB.
/// The model is at the map afterwards.
[[nodiscard]] SmoothMap FitSmoothMap(const MapProblem& problem,
                                     const FieldPrior& prior,
                                     const LevelFit& homogeneous);

/// Returns ln of the evidence of the field of a map with another prior, up to a
/// constant.  The modes of the map with k lambda >= 3 stand for S^T Pi S, in
/// place of solves; they are the same for all priors that are compared.  O(n
/// r^2) for r modes.  Preconditions: the model is at the map, which has this
/// `prior`.
[[nodiscard]] double LogEvidenceByModes(const MapProblem& problem,
                                        const FieldPrior& other,
                                        const FieldPrior& prior,
                                        const SmoothMap& map);

}  // namespace elastimate

#endif  // ELASTIMATE_ESTIMATORS_MAPS_SMOOTH_MAP_H_
