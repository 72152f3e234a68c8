#ifndef ELASTIMATE_ESTIMATORS_PLAN_SIZED_LOADS_H_
#define ELASTIMATE_ESTIMATORS_PLAN_SIZED_LOADS_H_

#include <Eigen/Core>
#include <optional>
#include <vector>

#include "elastimate/core/scene/scene.h"
#include "elastimate/core/solvers/stiffness_solver.h"
#include "elastimate/estimators/plan/load_plan.h"

namespace elastimate {

/// A candidate at its size.
struct SizedCandidate {
  Eigen::MatrixXd information;  ///< About the free parameters.
  /// By which the load was multiplied; empty where it displaces nothing.
  std::optional<double> factor;
};

/// What the load cases of a scene say together, and each candidate.
struct SizedLoads {
  Eigen::MatrixXd known;
  std::vector<SizedCandidate> candidates;
};

/// The elements of a plan: the elements of the mesh, or those of fits, which
/// are quadratic ones in place of linear ones if displacements are measured.
enum class PlannedElements { kOfMesh, kOfFits };

/// Returns the expected information at the size that candidates are taken at;
/// preconditions, exceptions and cost are those of PlanLoads.
[[nodiscard]] SizedLoads SizeLoads(const Scene& scene,
                                   const std::vector<CandidateLoad>& candidates,
                                   const Eigen::VectorXd& parameters,
                                   double relative_noise, SolverKind solver,
                                   PlannedElements elements);

}  // namespace elastimate

#endif  // ELASTIMATE_ESTIMATORS_PLAN_SIZED_LOADS_H_
