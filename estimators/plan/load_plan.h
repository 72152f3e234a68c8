#ifndef ELASTIMATE_ESTIMATORS_PLAN_LOAD_PLAN_H_
#define ELASTIMATE_ESTIMATORS_PLAN_LOAD_PLAN_H_

#include <Eigen/Core>
#include <optional>
#include <string>
#include <vector>

#include "elastimate/core/scene/scene.h"
#include "elastimate/core/solvers/stiffness_solver.h"
#include "elastimate/estimators/interface/estimate.h"
#include "elastimate/estimators/plan/expected_errors.h"

namespace elastimate {

/// A load that could be measured next.
struct CandidateLoad {
  std::string name;
  /// Its loads, and what would be observed; displacements say only which.
  LoadCase load_case;
  /// Whether it is taken as large as displaces the specimen as much as the load
  /// cases of the scene do, rather than as it is.
  bool is_free_in_size = false;
};

/// What one more load case leaves uncertain, beside those of the scene.
struct PlannedLoad {
  std::size_t candidate;  ///< Its place among the candidates.
  ExpectedErrors errors;
  /// By which the load was multiplied; empty where it displaces nothing.
  std::optional<double> factor;
};

/// Which load to measure next.  Errors are relative for moduli and absolute for
/// other parameters, of those that are not known.
struct LoadPlan {
  /// All parameters of the materials, with their values.
  std::vector<ParameterEstimate> parameters;
  ExpectedErrors before;  ///< By the load cases of the scene alone.
  /// What each candidate leaves, the smallest errors first
  /// (ExpectedErrors::AreSmallerThan).
  std::vector<PlannedLoad> loads;
  /// The candidates to measure one after another, each the best beside those
  /// before, until all parameters are determined (AreDetermined); the errors
  /// are those of all up to this one.
  std::vector<PlannedLoad> sequence;

  /// The free parameters among `parameters`.
  std::vector<ParameterEstimate> Free() const;
  /// Whether no standard error is above what Limits call undetermined.
  bool AreDetermined(const ExpectedErrors& errors) const;
};

/// Compares candidates by the information that is expected of them at
/// `parameters` (ExpectedInformation), as the worst combination of parameters
/// is determined: E-optimal designs [Ehrenfeld 1955; Pukelsheim, Optimal Design
/// of Experiments].  No measurement is needed.  The sequence is greedy.
///
/// `relative_noise` is that of load cases, of the scene and candidates, which
/// say nothing of their noise.  A load that is free in size is scaled to the
/// root mean square displacement of the load cases of the scene.
///
/// If displacements are measured (Origin::kMeasured), the plan is computed with
/// quadratic elements in place of linear ones, as fits are: linear elements
/// bend too little.  Otherwise it is computed with the elements of the mesh.
///
/// Cost: that of ExpectedInformation with these elements, for the load cases of
/// the scene and all candidates.
///
/// Throws as ExpectedInformation does, and std::invalid_argument for a scene
/// that is invalid or not held, parameters that are not those of its
/// materials, no free parameter, no candidates, or noise that is not positive.
[[nodiscard]] LoadPlan PlanLoads(const Scene& scene,
                                 const std::vector<CandidateLoad>& candidates,
                                 const Eigen::VectorXd& parameters,
                                 double relative_noise,
                                 SolverKind solver = SolverKind::kAutomatic);

/// A load case of which the same is observed as of another, with its noise.
[[nodiscard]] LoadCase ObservedAs(const LoadCase& observed, LoadCase load_case);

/// The unit loads on some facets (UnitLoads) as candidates that are observed as
/// the first load case of the scene is, and held as it is, at zero.
[[nodiscard]] std::vector<CandidateLoad> UnitCandidates(
    const Scene& scene, const Eigen::MatrixXi& facets);

/// Typical parameters of the materials of a scene, with the known ones; moduli
/// so large that the displacements are those measured, where all load cases
/// have some.
[[nodiscard]] Eigen::VectorXd TypicalParameters(const Scene& scene,
                                                SolverKind solver);

/// A combination of parameters for people, by labels: "E up with nu down".  The
/// four largest shares are named, of those above a fifth of the largest.
[[nodiscard]] std::string CombinationInWords(
    const Eigen::VectorXd& combination,
    const std::vector<ParameterEstimate>& free);

}  // namespace elastimate

#endif  // ELASTIMATE_ESTIMATORS_PLAN_LOAD_PLAN_H_
