#include "elastimate/estimators/interface/rules.h"

#include <algorithm>
#include <cmath>

#include "elastimate/estimators/interface/finding_sentences.h"
#include "elastimate/estimators/interface/limits.h"

namespace elastimate {
namespace {

using Result = std::optional<Finding>;

Result JudgeLoadBalance(const Evidence& evidence, const EstimatorOptions&,
                        const Estimate&) {
  const double imbalance = evidence.load_imbalance.value_or(0);
  if (!(imbalance > kLimits.notable_youngs_modulus_error)) {
    return std::nullopt;
  }
  return LoadsOutOfBalance(imbalance, imbalance > kLimits.unusable_error
                                          ? Severity::kError
                                          : Severity::kWarning);
}

Result JudgeLoadWork(const Evidence& evidence, const EstimatorOptions&,
                     const Estimate&) {
  return evidence.do_loads_work ? Result() : LoadsDoNoWork();
}

Result JudgeSigns(const Evidence& evidence, const EstimatorOptions&,
                  const Estimate&) {
  return evidence.do_displacements_oppose_loads ? DisplacementsOpposeLoads()
                                                : Result();
}

Result JudgeDivergence(const Evidence& evidence, const EstimatorOptions&,
                       const Estimate&) {
  return evidence.does_youngs_modulus_diverge ? YoungsModulusDiverges()
                                              : Result();
}

Result JudgeFreeDirection(const Evidence& evidence, const EstimatorOptions&,
                          const Estimate&) {
  return evidence.free_direction
             ? OneCombination(evidence.free_direction->at,
                              evidence.free_direction->direction)
             : Result();
}

Result JudgeDependence(const Evidence& evidence, const EstimatorOptions&,
                       const Estimate&) {
  return evidence.are_forces_dependent ? DependentForces() : Result();
}

Result JudgeEnd(const Evidence& evidence, const EstimatorOptions& options,
                const Estimate&) {
  switch (evidence.end) {
    case End::kSingularStiffness:
      return SingularStiffness();
    case End::kSearchFailed:
      return SearchFailed(evidence.search_message);
    case End::kIterationLimit:
      return NoConvergence(options.max_iterations);
    case End::kNotCertified:  // Matters to what is usable otherwise.
    case End::kDone:
      break;
  }
  return std::nullopt;
}

Result JudgeCount(const Evidence& evidence, const EstimatorOptions&,
                  const Estimate&) {
  return evidence.too_few_components
             ? TooFewMeasurements(*evidence.too_few_components)
             : Result();
}

Result NoteResidualAboveNoise(const Evidence& evidence, const EstimatorOptions&,
                              const Estimate&) {
  return evidence.above_noise ? ResidualAboveNoise(evidence.above_noise->kind,
                                                   evidence.above_noise->ratio)
                              : Result();
}

Result NoteOutliers(const Evidence& evidence, const EstimatorOptions&,
                    const Estimate& estimate) {
  return evidence.outlier_change && std::abs((*evidence.outlier_change)(0)) >
                                        kLimits.notable_youngs_modulus_error
             ? (estimate.is_model_in_doubt
                    ? FarNeighbours()
                    : Outliers(*evidence.outlier_change, estimate))
             : Result();
}

Result NoteSmoothResidual(const Evidence& evidence, const EstimatorOptions&,
                          const Estimate& estimate) {
  return evidence.smooth_residual_error &&
                 *evidence.smooth_residual_error >
                     kLimits.notable_youngs_modulus_error
             ? SmoothResidual(*estimate.residual_correlation)
             : Result();
}

Result NoteAxes(const Evidence& evidence, const EstimatorOptions&,
                const Estimate&) {
  const std::optional<AxisTurn>& turn = evidence.axis_turn;
  return turn && turn->probability < kLimits.axis_significance &&
                 turn->change > kLimits.notable_youngs_modulus_error &&
                 turn->change_in_errors > 1
             ? AxisTurned(turn->angle, turn->region, turn->change)
             : Result();
}

Result NoteVirtualWork(const Evidence& evidence, const EstimatorOptions&,
                       const Estimate&) {
  return evidence.virtual_work_error.value_or(0) >
                 kLimits.notable_youngs_modulus_error
             ? VirtualWorkImbalance()
             : Result();
}

// A bound that the data contradict leaves much that is no noise.
Result JudgeBoundExcess(const Evidence& evidence, const EstimatorOptions&,
                        const Estimate&) {
  if (!evidence.bound_excess) {
    return std::nullopt;
  }
  const BoundExcess& bound = *evidence.bound_excess;
  return std::abs(bound.without / bound.with - 1) > kLimits.unusable_error &&
                 bound.excess > kLimits.significant_score *
                                    kLimits.significant_score * bound.variance
             ? BoundContradicted(bound.label, bound.without < bound.with)
             : Result();
}

Result JudgeLargeResidual(const Evidence& evidence, const EstimatorOptions&,
                          const Estimate& estimate) {
  // What is not known to be the best fit may leave more than the model does.
  if (!evidence.smooth_part || evidence.end == End::kNotCertified) {
    return std::nullopt;
  }
  if (*evidence.smooth_part > kLimits.large_residual) {
    return LargeSmoothResidual(*evidence.smooth_part);
  }
  return *estimate.displacement_residual > kLimits.large_residual &&
                 *evidence.smooth_part == 0 &&
                 !evidence.is_explained_by_given_noise
             ? LargeResidual(*estimate.displacement_residual)
             : Result();
}

Result JudgeKnownRatio(const Evidence& evidence, const EstimatorOptions&,
                       const Estimate&) {
  // Rounding has no standard error.
  constexpr double kRounding = 1e-6;
  if (!evidence.known_ratio) {
    return std::nullopt;
  }
  const KnownRatio& known = *evidence.known_ratio;
  if (!(std::abs(known.difference) >
        kLimits.significant_score * known.standard_error + kRounding)) {
    return std::nullopt;
  }
  return KnownPoissonRatioContradicted(
      known.label, known.asked_for, known.standard_error,
      known.change_of_moduli <= kLimits.unusable_error ? Severity::kWarning
                                                       : Severity::kError);
}

Result JudgeWorkCheck(const Evidence& evidence, const EstimatorOptions&,
                      const Estimate& estimate) {
  switch (evidence.work_check) {
    case WorkCheck::kIsMore:
      return VirtualWorkImbalance(*estimate.force_residual, Severity::kWarning);
    case WorkCheck::kContradicts:
      return VirtualWorkImbalance(*estimate.force_residual, Severity::kError);
    case WorkCheck::kIsNoise:
    case WorkCheck::kNotMade:
      break;
  }
  return std::nullopt;
}

Result NoteResultants(const Evidence& evidence, const EstimatorOptions&,
                      const Estimate&) {
  return evidence.resultant_misfit && evidence.resultant_misfit->Excess() > 1
             ? ResultantsContradicted(
                   evidence.resultant_misfit->distances.cwiseAbs().maxCoeff())
             : Result();
}

Result JudgeCorrection(const Evidence& evidence, const EstimatorOptions&,
                       const Estimate&) {
  return evidence.correction.value_or(0) > kLimits.large_residual
             ? LargeCorrection(*evidence.correction)
             : Result();
}

Result JudgeRatiosAtLimit(const Evidence& evidence, const EstimatorOptions&,
                          const Estimate& estimate) {
  if (evidence.ratios_at_limit.empty()) {
    return std::nullopt;
  }
  if (evidence.is_a_ratio_at_minus_one) {
    return PoissonRatioAtMinusOne();
  }
  if (estimate.noise_attenuation) {
    return PoissonRatioDivergesByNoise();
  }
  // The fit without them is too far for a linear model.
  if (evidence.outlier_change) {
    return OutliersAtLimit(evidence.ratios_at_limit);
  }
  return estimate.is_model_in_doubt ? RatiosAtLimit(evidence.ratios_at_limit)
                                    : Result();
}

Result NoteSupportEnds(const Evidence& evidence, const EstimatorOptions&,
                       const Estimate& estimate) {
  return evidence.support_errors &&
                 AreNotable(*evidence.support_errors, estimate)
             ? SupportsEndWithinElements(*evidence.support_errors, estimate)
             : Result();
}

Result JudgeCertificate(const Evidence& evidence, const EstimatorOptions&,
                        const Estimate&) {
  return evidence.end == End::kNotCertified ? FitNotCertified() : Result();
}

Result NoteSolver(const Evidence& evidence, const EstimatorOptions&,
                  const Estimate&) {
  return evidence.solver_notice.empty()
             ? Result()
             : SolverFallback(evidence.solver_notice);
}

}  // namespace

bool AreNotable(const ParameterErrors& errors, const Estimate& estimate) {
  const Eigen::MatrixXd& covariance = estimate.parameter_covariance;
  if (errors.size() != Eigen::Index(estimate.parameters.size())) {
    return false;
  }
  for (Eigen::Index i = 0; i < errors.size(); ++i) {
    const ParameterEstimate& parameter = estimate.parameters[i];
    const double variance = covariance.size() != 0 ? covariance(i, i) : 0;
    const double standard_error =
        variance > 0 ? std::sqrt(variance) / parameter.ErrorUnit() : 0;
    if (errors(i) >
        std::max(parameter.IsStiffness() ? kLimits.notable_youngs_modulus_error
                                         : kLimits.notable_poisson_ratio_error,
                 kLimits.notable_discretization_share * standard_error)) {
      return true;
    }
  }
  return false;
}

const std::vector<Rule>& Rules() {
  static const std::vector<Rule> rules = {
      // Whether there is anything to estimate.
      JudgeLoadBalance, JudgeLoadWork, JudgeSigns, JudgeDivergence,
      JudgeFreeDirection, JudgeDependence, JudgeEnd, JudgeCount,
      // What to say of a usable estimate.
      NoteResidualAboveNoise, NoteOutliers, NoteSmoothResidual, NoteAxes,
      NoteVirtualWork, NoteResultants, NoteSupportEnds,
      // Whether the data determine it, and the model explains them.
      JudgeBoundExcess, JudgeLargeResidual, JudgeKnownRatio, JudgeRatiosAtLimit,
      JudgeWorkCheck, JudgeCorrection, JudgeCertificate, NoteSolver};
  return rules;
}

}  // namespace elastimate
