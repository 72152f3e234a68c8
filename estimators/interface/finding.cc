#include "elastimate/estimators/interface/finding.h"

#include <cassert>
#include <cstddef>

namespace elastimate {
namespace {

struct Row {
  FindingCode code;
  const char* name;
  // Of an estimate that is not usable for this reason.
  Status status = Status::kNotIdentifiable;
};

// One row for each code, in their order.
constexpr Row kRows[] = {
    {FindingCode::kNotRun, "not_run", Status::kNumericalFailure},
    {FindingCode::kNotFinite, "not_finite", Status::kNumericalFailure},
    {FindingCode::kSingularStiffness, "singular_stiffness",
     Status::kNumericalFailure},
    {FindingCode::kSearchFailed, "search_failed", Status::kNumericalFailure},
    {FindingCode::kNoConvergence, "no_convergence", Status::kIterationLimit},
    {FindingCode::kFitNotCertified, "fit_not_certified",
     Status::kIterationLimit},
    {FindingCode::kUnphysical, "unphysical", Status::kUnphysical},
    {FindingCode::kDisplacementsOpposeLoads, "displacements_oppose_loads",
     Status::kUnphysical},
    {FindingCode::kYoungsModulusDiverges, "youngs_modulus_diverges",
     Status::kUnphysical},
    {FindingCode::kPoissonRatioDiverges, "poisson_ratio_diverges",
     Status::kUnphysical},
    {FindingCode::kLoadsDoNoWork, "loads_do_no_work"},
    {FindingCode::kOneCombination, "one_combination"},
    {FindingCode::kYoungsModulusUndetermined, "youngs_modulus_undetermined"},
    {FindingCode::kPoissonRatioUndetermined, "poisson_ratio_undetermined"},
    {FindingCode::kTooFewMeasurements, "too_few_measurements"},
    {FindingCode::kBoundContradicted, "bound_contradicted"},
    {FindingCode::kKnownPoissonRatioContradicted,
     "known_poisson_ratio_contradicted"},
    {FindingCode::kLargeCorrection, "large_correction"},
    {FindingCode::kLoadsOutOfBalance, "loads_out_of_balance"},
    {FindingCode::kResidualAboveNoise, "residual_above_noise"},
    {FindingCode::kSmoothResidual, "smooth_residual"},
    {FindingCode::kLargeResidual, "large_residual"},
    {FindingCode::kVirtualWorkImbalance, "virtual_work_imbalance"},
    {FindingCode::kModelMismatch, "model_mismatch"},
    {FindingCode::kOutliers, "outliers"},
    {FindingCode::kHeldNodesMoved, "held_nodes_moved"},
    {FindingCode::kNoiseBias, "noise_bias"},
    {FindingCode::kYoungsModulusOnBound, "youngs_modulus_on_bound"},
    {FindingCode::kPoissonRatioOnBound, "poisson_ratio_on_bound"},
    {FindingCode::kPoissonRatioAtLimit, "poisson_ratio_at_limit"},
    {FindingCode::kLocking, "locking"},
    {FindingCode::kDiscretizationError, "discretization_error"},
    {FindingCode::kLinearElementsFitAsWell, "linear_elements_fit_as_well"},
    {FindingCode::kTooManyElements, "too_many_elements"},
    {FindingCode::kSolverFallback, "solver_fallback"},
};

const Row& RowOf(FindingCode code) {
  const Row& row = kRows[static_cast<std::size_t>(code)];
  assert(row.code == code);
  return row;
}

}  // namespace

std::string_view StatusName(Status status) {
  switch (status) {
    case Status::kOk:
      return "ok";
    case Status::kNotIdentifiable:
      return "not_identifiable";
    case Status::kUnphysical:
      return "unphysical";
    case Status::kIterationLimit:
      return "iteration_limit";
    case Status::kNumericalFailure:
      break;
  }
  return "numerical_failure";
}

std::string_view FindingCodeName(FindingCode code) { return RowOf(code).name; }

std::string_view SeverityName(Severity severity) {
  switch (severity) {
    case Severity::kNotice:
      return "notice";
    case Severity::kWarning:
      return "warning";
    case Severity::kError:
      break;
  }
  return "error";
}

Status StatusOf(FindingCode code) { return RowOf(code).status; }

std::vector<FindingCode> AllFindingCodes() {
  std::vector<FindingCode> codes;
  for (const Row& row : kRows) {
    codes.push_back(row.code);
  }
  return codes;
}

std::string Sentence(const Finding& finding) {
  return finding.text + "; " + finding.advice;
}

}  // namespace elastimate
