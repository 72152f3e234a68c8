#include "elastimate/estimators/interface/finding.h"

#include <cassert>
#include <cstddef>

namespace elastimate {
namespace {

struct Row {
  const char* name;
  FindingCode code;
  // The status of an estimate that is not usable for this reason.
  Status status = Status::kNotIdentifiable;
};

// One row for each code, in their order.
constexpr Row kRows[] = {
    {"not_run", FindingCode::kNotRun, Status::kNumericalFailure},
    {"not_finite", FindingCode::kNotFinite, Status::kNumericalFailure},
    {"singular_stiffness", FindingCode::kSingularStiffness,
     Status::kNumericalFailure},
    {"search_failed", FindingCode::kSearchFailed, Status::kNumericalFailure},
    {"no_convergence", FindingCode::kNoConvergence, Status::kIterationLimit},
    {"fit_not_certified", FindingCode::kFitNotCertified,
     Status::kIterationLimit},
    {"errors_missing", FindingCode::kErrorsMissing, Status::kNumericalFailure},
    {"unphysical", FindingCode::kUnphysical, Status::kUnphysical},
    {"displacements_oppose_loads", FindingCode::kDisplacementsOpposeLoads,
     Status::kUnphysical},
    {"youngs_modulus_diverges", FindingCode::kYoungsModulusDiverges,
     Status::kUnphysical},
    {"poisson_ratio_diverges", FindingCode::kPoissonRatioDiverges,
     Status::kUnphysical},
    {"loads_do_no_work", FindingCode::kLoadsDoNoWork},
    {"one_combination", FindingCode::kOneCombination},
    {"parameters_undetermined", FindingCode::kParametersUndetermined},
    {"axis_undetermined", FindingCode::kAxisUndetermined},
    {"combinations_only", FindingCode::kCombinationsOnly},
    {"too_few_measurements", FindingCode::kTooFewMeasurements},
    {"no_frame_usable", FindingCode::kNoFrameUsable},
    {"large_deformation", FindingCode::kLargeDeformation},
    {"negative_poisson_ratio", FindingCode::kNegativePoissonRatio},
    {"margin_not_given", FindingCode::kMarginNotGiven},
    {"prior_contradicted", FindingCode::kPriorContradicted},
    {"bound_contradicted", FindingCode::kBoundContradicted},
    {"known_poisson_ratio_contradicted",
     FindingCode::kKnownPoissonRatioContradicted},
    {"large_correction", FindingCode::kLargeCorrection},
    {"loads_out_of_balance", FindingCode::kLoadsOutOfBalance},
    {"residual_above_noise", FindingCode::kResidualAboveNoise},
    {"smooth_residual", FindingCode::kSmoothResidual},
    {"residual_in_region", FindingCode::kResidualInRegion},
    {"axis_turned", FindingCode::kAxisTurned},
    {"large_residual", FindingCode::kLargeResidual},
    {"virtual_work_imbalance", FindingCode::kVirtualWorkImbalance},
    {"outliers", FindingCode::kOutliers},
    {"outliers_left_out", FindingCode::kOutliersLeftOut},
    {"held_nodes_moved", FindingCode::kHeldNodesMoved},
    {"resultants_contradicted", FindingCode::kResultantsContradicted},
    {"regions_may_differ", FindingCode::kRegionsMayDiffer},
    {"regions_not_compared", FindingCode::kRegionsNotCompared},
    {"laws_fit_alike", FindingCode::kLawsFitAlike},
    {"frames_left_out", FindingCode::kFramesLeftOut},
    {"trend_over_frames", FindingCode::kTrendOverFrames},
    {"frames_scatter", FindingCode::kFramesScatter},
    {"frames_alike", FindingCode::kFramesAlike},
    {"noise_bias", FindingCode::kNoiseBias},
    {"poisson_ratio_at_limit", FindingCode::kPoissonRatioAtLimit},
    {"parameters_on_bounds", FindingCode::kParametersOnBounds},
    {"parameters_near_limits", FindingCode::kParametersNearLimits},
    {"discretization_error", FindingCode::kDiscretizationError},
    {"mesh_error_unknown", FindingCode::kMeshErrorUnknown},
    {"computed_by_linear_elements", FindingCode::kComputedByLinearElements},
    {"supports_end_within_elements", FindingCode::kSupportsEndWithinElements},
    {"solver_fallback", FindingCode::kSolverFallback},
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
