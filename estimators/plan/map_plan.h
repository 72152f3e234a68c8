#ifndef ELASTIMATE_ESTIMATORS_PLAN_MAP_PLAN_H_
#define ELASTIMATE_ESTIMATORS_PLAN_MAP_PLAN_H_

#include <cstddef>
#include <optional>
#include <vector>

#include "elastimate/core/laws/elasticity.h"
#include "elastimate/core/scene/scene.h"
#include "elastimate/core/solvers/stiffness_solver.h"
#include "elastimate/estimators/plan/load_plan.h"

namespace elastimate {

/// What one more load case tells of a map, beside those of the scene.
struct PlannedMapLoad {
  std::size_t candidate;  ///< Its place among the candidates.
  double supported_parameters;
  /// By which the load was multiplied; empty where it displaces nothing.
  std::optional<double> factor;
};

/// Which load to measure next for a map of Young's modulus.
struct MapPlan {
  double supported_before;  ///< By the load cases of the scene alone.
  /// The load that supports the most parameters comes first.
  std::vector<PlannedMapLoad> loads;
};

/// The standard deviation of ln E that a plan expects: a factor of 1.6.
inline constexpr double kExpectedSpread = 0.5;
/// The largest number of elements of a plan, whose matrices are dense.
inline constexpr int kMostElementsOfPlan = 2000;

/// Compares candidates by the number of parameters beside the level of E that
/// they are expected to support with the load cases of the scene,
///
///   gamma = tr(tau^2 H (1 + tau^2 H)^-1),   H = A^T I A,
///
/// with the information I about ln E of each element (ExpectedInformation at a
/// homogeneous body of this elasticity), less what its level explains, and the
/// FieldPrior A of inclusions with tau = kExpectedSpread.  nu counts as known.
///
/// Preconditions, sizes of loads, noise and exceptions are those of PlanLoads;
/// the materials of the scene do not count.  Throws std::invalid_argument for
/// more than kMostElementsOfPlan elements.  Cost: a solve for each element and
/// load case, and O(num_elements^3) for each candidate.
[[nodiscard]] MapPlan PlanMap(const Scene& scene,
                              const std::vector<CandidateLoad>& candidates,
                              const IsotropicElasticity& elasticity,
                              double relative_noise, SolverKind solver);

}  // namespace elastimate

#endif  // ELASTIMATE_ESTIMATORS_PLAN_MAP_PLAN_H_
