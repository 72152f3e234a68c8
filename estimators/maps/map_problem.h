#ifndef ELASTIMATE_ESTIMATORS_MAPS_MAP_PROBLEM_H_
#define ELASTIMATE_ESTIMATORS_MAPS_MAP_PROBLEM_H_

#include <Eigen/Core>
#include <functional>
#include <optional>

#include "elastimate/estimators/maps/field_sensitivity.h"

namespace elastimate {

/// ln E of each element, up to the unit, and nu of all.
struct MapState {
  Eigen::VectorXd log_moduli;
  double poisson_ratio = 0;
};

/// The model of a map, and what is given beside the displacements.
struct MapProblem {
  FieldSensitivity& model;
  std::optional<double> known_poisson_ratio;
  /// The standard deviation of a row, where it is known.
  std::optional<double> noise;

  /// Returns the variance of a row: as given, or else of a fit that leaves this
  /// square sum and so many degrees of freedom.
  double Variance(double square_sum, double degrees_of_freedom) const;
};

/// The unknowns without a prior at a state of the model: levels z of ln E on
/// parts of the body, and nu, by its LogStiffnessRatio,
///
///   Z = [S G, s_nu],   Pi = I - Z (Z^T Z)^-1 Z^T.
///
/// They are eliminated exactly.  A column that is zero, as the level of E is
/// where there are displacements alone, is left out.
class FlatUnknowns {
 public:
  /// `parts` (num_elements x n) are G.  Precondition: the model is at `state`.
  /// Cost: a solve for each load case and column.
  FlatUnknowns(const MapProblem& problem, const MapState& state,
               const Eigen::MatrixXd& parts);

  Eigen::Index Rank() const { return basis_.cols(); }
  /// Returns Pi W.
  Eigen::MatrixXd Project(const Eigen::MatrixXd& rows) const;
  /// Returns (Z^T Z)^-1 Z^T W: the change of the levels, and last of the
  /// LogStiffnessRatio of nu, zero where it is known.
  Eigen::MatrixXd Solve(const Eigen::MatrixXd& rows) const;
  /// Returns (Z^T Z)^-1, with zeros for what is left out.
  Eigen::MatrixXd InverseGram() const;

 private:
  Eigen::MatrixXd columns_;
  Eigen::MatrixXd basis_;
  bool has_free_ratio_;
};

/// Returns the state after a step of ln E and the LogStiffnessRatio of nu, with
/// nu in the range that a fit searches.
[[nodiscard]] MapState Stepped(const MapState& state,
                               const Eigen::VectorXd& of_log_moduli,
                               double of_log_stiffness_ratio);

/// Returns the largest factor of at most 1 by which no modulus changes more
/// than twofold in ln E, nor nu as much.
[[nodiscard]] double LargestStep(const Eigen::VectorXd& of_log_moduli,
                                 double of_log_stiffness_ratio);

/// Tells whether the model, which is at `next`, is better there; `next` is this
/// share of a step away.
using MapImprovement = std::function<bool(double share, const MapState& next)>;

/// Takes the largest share of a step that is better: LargestStep or, with at
/// most so many attempts, a half of it, a quarter, and so on.  Moves `state`
/// and the model there.  Returns the share; zero if none is better, and the
/// model is back at `state` then.  A factorisation for each attempt.
double TakeStep(const MapProblem& problem, const Eigen::VectorXd& of_log_moduli,
                double of_log_stiffness_ratio, double noise, int most_attempts,
                const MapImprovement& is_better, MapState& state);

}  // namespace elastimate

#endif  // ELASTIMATE_ESTIMATORS_MAPS_MAP_PROBLEM_H_
