#include "elastimate/estimators/interface/rules.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "elastimate/estimators/interface/finding_sentences.h"
#include "elastimate/estimators/interface/limits.h"

namespace elastimate {
namespace {

// Collects what the rules find.
class RuleBook {
 public:
  RuleBook(const Evidence& evidence, const EstimatorOptions& options,
           const Estimate& estimate)
      : evidence_(evidence), options_(options), estimate_(estimate) {}

  std::vector<Finding> Apply() && {
    JudgeData();
    NoteWhatIsUsable();
    JudgeModel();
    return std::move(findings_);
  }

 private:
  void Add(Finding finding) { findings_.push_back(std::move(finding)); }

  // Whether there is anything to estimate.
  void JudgeData();
  // What to say of a usable estimate.
  void NoteWhatIsUsable();
  // Whether the data determine it, and the model explains them.
  void JudgeModel();

  void JudgeLoadBalance();
  void JudgeEnd();
  void NoteOutliers();
  void NoteAxes();
  void JudgeBoundExcess();
  void JudgeLargeResidual();
  void JudgeKnownRatio();
  bool AreUndetermined(const std::vector<std::string>& ratios) const;
  void JudgeRatiosAtLimit();
  void JudgeWorkCheck();

  const Evidence& evidence_;
  const EstimatorOptions& options_;
  const Estimate& estimate_;
  std::vector<Finding> findings_;
};

void RuleBook::JudgeData() {
  JudgeLoadBalance();
  if (!evidence_.do_loads_work) {
    Add(LoadsDoNoWork());
  }
  if (evidence_.do_displacements_oppose_loads) {
    Add(DisplacementsOpposeLoads());
  }
  if (evidence_.does_youngs_modulus_diverge) {
    Add(YoungsModulusDiverges());
  }
  if (const auto& free = evidence_.free_direction) {
    Add(OneCombination(free->at, free->direction));
  }
  if (evidence_.are_forces_dependent) {
    Add(DependentForces());
  }
  JudgeEnd();
  if (evidence_.too_few_components) {
    Add(TooFewMeasurements(*evidence_.too_few_components));
  }
}

void RuleBook::NoteWhatIsUsable() {
  if (const auto& residual = evidence_.above_noise) {
    Add(ResidualAboveNoise(residual->kind, residual->ratio));
  }
  NoteOutliers();
  if (evidence_.smooth_residual_error.value_or(0) >
      kLimits.notable_youngs_modulus_error) {
    Add(SmoothResidual(*estimate_.residual_correlation));
  }
  NoteAxes();
  if (evidence_.virtual_work_error.value_or(0) >
      kLimits.notable_youngs_modulus_error) {
    Add(VirtualWorkImbalance());
  }
  if (const auto& misfit = evidence_.resultant_misfit;
      misfit && misfit->Excess() > 1) {
    Add(ResultantsContradicted(misfit->distances.cwiseAbs().maxCoeff()));
  }
  if (const auto& errors = evidence_.support_errors;
      errors && AreNotable(*errors, estimate_)) {
    Add(SupportsEndWithinElements(*errors, estimate_));
  }
}

void RuleBook::JudgeModel() {
  JudgeBoundExcess();
  JudgeLargeResidual();
  JudgeKnownRatio();
  JudgeRatiosAtLimit();
  JudgeWorkCheck();
  if (evidence_.correction.value_or(0) > kLimits.large_residual) {
    Add(LargeCorrection(*evidence_.correction));
  }
  if (evidence_.end == End::kNotCertified) {
    Add(FitNotCertified());
  }
  if (!evidence_.solver_notice.empty()) {
    Add(SolverFallback(evidence_.solver_notice));
  }
}

void RuleBook::JudgeLoadBalance() {
  const double imbalance = evidence_.load_imbalance.value_or(0);
  if (imbalance > kLimits.notable_youngs_modulus_error) {
    Add(LoadsOutOfBalance(imbalance, imbalance > kLimits.unusable_error
                                         ? Severity::kError
                                         : Severity::kWarning));
  }
}

void RuleBook::JudgeEnd() {
  switch (evidence_.end) {
    case End::kSingularStiffness:
      return Add(SingularStiffness());
    case End::kSearchFailed:
      return Add(SearchFailed(evidence_.search_message));
    case End::kIterationLimit:
      return Add(NoConvergence(options_.max_iterations));
    case End::kNotCertified:  // Matters to what is usable otherwise.
    case End::kDone:
      break;
  }
}

void RuleBook::NoteOutliers() {
  const std::optional<Eigen::Vector2d>& change = evidence_.outlier_change;
  if (change && std::abs((*change)(0)) > kLimits.notable_youngs_modulus_error) {
    Add(estimate_.is_model_in_doubt ? FarNeighbours()
                                    : Outliers(*change, estimate_));
  }
}

void RuleBook::NoteAxes() {
  const std::optional<AxisTurn>& turn = evidence_.axis_turn;
  if (turn && turn->probability < kLimits.axis_significance &&
      turn->change > kLimits.notable_youngs_modulus_error &&
      turn->change_in_errors > 1) {
    Add(AxisTurned(turn->angle, turn->region, turn->change));
  }
}

// A bound that the data contradict leaves much that is no noise.
void RuleBook::JudgeBoundExcess() {
  const std::optional<BoundExcess>& bound = evidence_.bound_excess;
  if (bound &&
      std::abs(bound->without / bound->with - 1) > kLimits.unusable_error &&
      bound->excess > kLimits.significant_score * kLimits.significant_score *
                          bound->variance) {
    Add(BoundContradicted(bound->label, bound->without < bound->with));
  }
}

void RuleBook::JudgeLargeResidual() {
  // What is not known to be the best fit may leave more than the model does.
  if (!evidence_.smooth_part || evidence_.end == End::kNotCertified) {
    return;
  }
  if (*evidence_.smooth_part > kLimits.large_residual) {
    Add(LargeSmoothResidual(*evidence_.smooth_part));
  } else if (*estimate_.displacement_residual > kLimits.large_residual &&
             *evidence_.smooth_part == 0 &&
             !evidence_.is_explained_by_given_noise) {
    Add(LargeResidual(*estimate_.displacement_residual));
  }
}

void RuleBook::JudgeKnownRatio() {
  // Rounding has no standard error.
  constexpr double kRounding = 1e-6;
  const std::optional<KnownRatio>& known = evidence_.known_ratio;
  if (known &&
      std::abs(known->difference) >
          kLimits.significant_score * known->standard_error + kRounding) {
    Add(KnownPoissonRatioContradicted(
        known->label, known->asked_for, known->standard_error,
        known->change_of_moduli <= kLimits.unusable_error ? Severity::kWarning
                                                          : Severity::kError));
  }
}

bool RuleBook::AreUndetermined(const std::vector<std::string>& ratios) const {
  const Eigen::MatrixXd& covariance = estimate_.parameter_covariance;
  const std::vector<ParameterEstimate>& parameters = estimate_.parameters;
  for (Eigen::Index i = 0; i < covariance.rows(); ++i) {
    if (std::find(ratios.begin(), ratios.end(), parameters[i].Label()) !=
            ratios.end() &&
        !(std::sqrt(covariance(i, i)) > kLimits.largest_poisson_ratio_error)) {
      return false;
    }
  }
  return covariance.rows() > 0;
}

void RuleBook::JudgeRatiosAtLimit() {
  const std::vector<std::string>& ratios = evidence_.ratios_at_limit;
  if (ratios.empty()) {
    return;
  }
  if (evidence_.is_a_ratio_at_minus_one) {
    // If nu is not determined, the data do not drive it to -1.
    if (!AreUndetermined(ratios)) {
      Add(PoissonRatioAtMinusOne());
    }
  } else if (estimate_.noise_attenuation) {
    Add(PoissonRatioDivergesByNoise());
  } else if (evidence_.outlier_change) {
    // The fit without them is too far for a linear model.
    Add(OutliersAtLimit(ratios));
  } else if (estimate_.is_model_in_doubt) {
    Add(RatiosAtLimit(ratios));
  }
}

void RuleBook::JudgeWorkCheck() {
  const WorkCheck check = evidence_.work_check;
  if (check == WorkCheck::kIsMore || check == WorkCheck::kContradicts) {
    Add(VirtualWorkImbalance(
        *estimate_.force_residual,
        check == WorkCheck::kIsMore ? Severity::kWarning : Severity::kError));
  }
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

std::vector<Finding> ApplyRules(const Evidence& evidence,
                                const EstimatorOptions& options,
                                const Estimate& estimate) {
  return RuleBook(evidence, options, estimate).Apply();
}

}  // namespace elastimate
