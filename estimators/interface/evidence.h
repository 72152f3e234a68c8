#ifndef ELASTIMATE_ESTIMATORS_INTERFACE_EVIDENCE_H_
#define ELASTIMATE_ESTIMATORS_INTERFACE_EVIDENCE_H_

#include <Eigen/Core>
#include <optional>
#include <string>
#include <vector>

#include "elastimate/core/laws/elasticity.h"
#include "elastimate/estimators/interface/estimate.h"

namespace elastimate {

/// How the numerics of a method ended.
enum class End {
  kDone,
  kSingularStiffness,
  kSearchFailed,
  kIterationLimit,
  kNotCertified,
};

/// Which residual a finding is about.
enum class ResidualKind { kDisplacement, kForce, kVirtualWork };

/// A residual that is significantly larger than the given noise.
struct ResidualRatio {
  ResidualKind kind;
  double ratio;  ///< To what the noise explains, in standard deviations.
};

/// A direction in (ln E, nu) that the data leave free.
struct FreeDirection {
  IsotropicElasticity at;
  Eigen::Vector2d direction;
};

/// What the bound on a modulus costs: the square sum exceeds its least by
/// `excess`.
struct BoundExcess {
  double excess;
  double variance;    ///< The variance of each residual.
  double without;     ///< The modulus that fits best.
  double with;        ///< The modulus of the estimate.
  std::string label;  ///< Names the modulus.
};

/// The known Poisson's ratio that the data contradict most.
struct KnownRatio {
  std::string label;  ///< Names the parameter.
  double difference;  ///< From what is known to what the data ask for.
  double asked_for;
  double standard_error;    ///< That what the data ask for has.
  double change_of_moduli;  ///< Their largest relative change by it.
};

/// Resultants against the forces of a fit, in their standard deviations.
struct ResultantMisfit {
  Eigen::VectorXd distances;

  /// Above 1 where they are further off than chance explains, in one scene of
  /// a thousand: by how much their variance is more than stated.
  double Excess() const;
};

/// A rotation of axes that were given, which would fit better.
struct AxisTurn {
  double angle;        ///< [rad]
  std::string region;  ///< "" for all of a specimen.
  /// How probable so large a gain is, were the axes right.
  double probability;
  /// The largest change of a parameter, relative or of a ratio, and of one in
  /// its standard errors by noise.
  double change;
  double change_in_errors;
};

/// What virtual work said of a force residual.
enum class WorkCheck { kNotMade, kIsNoise, kIsMore, kContradicts };

/// What a method measured of its estimate, for the judge.  What is empty was
/// not measured, or does not arise.
struct Evidence {
  /// Share of the loads that push motions which the supports leave free.
  std::optional<double> load_imbalance;
  std::optional<FreeDirection> free_direction;
  /// Measured components, where they are too few for statistics.
  std::optional<Eigen::Index> too_few_components;

  std::optional<ResidualRatio> above_noise;
  /// How E (relative) and nu change without the pull of outliers.
  std::optional<Eigen::Vector2d> outlier_change;
  /// Standard errors by what supports that end within elements leave open.
  std::optional<ParameterErrors> support_errors;
  /// Relative standard error of E by what is smooth in the residual.
  std::optional<double> smooth_residual_error;
  /// The smooth part of the displacement residual over the measurement.
  std::optional<double> smooth_part;
  /// Relative standard error of E where virtual work finds more than noise.
  std::optional<double> virtual_work_error;
  /// The change of the displacements that balances the loads, relative to them.
  std::optional<double> correction;

  std::optional<AxisTurn> axis_turn;
  std::optional<ResultantMisfit> resultant_misfit;
  std::optional<BoundExcess> bound_excess;
  std::optional<KnownRatio> known_ratio;

  std::string search_message;  ///< Why the search failed.
  std::string solver_notice;
  End end = End::kDone;
  WorkCheck work_check = WorkCheck::kNotMade;
  /// Poisson's ratios at the end of their range.
  std::vector<std::string> ratios_at_limit;
  bool is_a_ratio_at_minus_one = false;
  bool do_loads_work = true;
  /// Whether the forces of some moduli are combinations of those of others.
  bool are_forces_dependent = false;
  bool do_displacements_oppose_loads = false;
  bool does_youngs_modulus_diverge = false;
  bool is_explained_by_given_noise = false;
};

}  // namespace elastimate

#endif  // ELASTIMATE_ESTIMATORS_INTERFACE_EVIDENCE_H_
