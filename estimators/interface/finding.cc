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
    {"numerical_failure", FindingCode::kNumericalFailure,
     Status::kNumericalFailure},
    {"no_convergence", FindingCode::kNoConvergence, Status::kIterationLimit},
    {"fit_not_certified", FindingCode::kFitNotCertified,
     Status::kIterationLimit},
    {"errors_missing", FindingCode::kErrorsMissing, Status::kNumericalFailure},
    {"unphysical", FindingCode::kUnphysical, Status::kUnphysical},
    {"parameters_undetermined", FindingCode::kParametersUndetermined},
    {"large_deformation", FindingCode::kLargeDeformation},
    {"negative_poisson_ratio", FindingCode::kNegativePoissonRatio},
    {"margin_not_given", FindingCode::kMarginNotGiven},
    {"prior_contradicted", FindingCode::kPriorContradicted},
    {"given_value_contradicted", FindingCode::kGivenValueContradicted},
    {"loads_out_of_balance", FindingCode::kLoadsOutOfBalance},
    {"residual_above_noise", FindingCode::kResidualAboveNoise},
    {"smooth_residual", FindingCode::kSmoothResidual},
    {"outliers", FindingCode::kOutliers},
    {"outliers_left_out", FindingCode::kOutliersLeftOut},
    {"held_nodes_moved", FindingCode::kHeldNodesMoved},
    {"inverted_elements", FindingCode::kInvertedElements},
    {"rigid_face_turned", FindingCode::kRigidFaceTurned},
    {"resultants_contradicted", FindingCode::kResultantsContradicted},
    {"regions_may_differ", FindingCode::kRegionsMayDiffer},
    {"laws_fit_alike", FindingCode::kLawsFitAlike},
    {"frames_left_out", FindingCode::kFramesLeftOut},
    {"trend_over_frames", FindingCode::kTrendOverFrames},
    {"frames_scatter", FindingCode::kFramesScatter},
    {"frames_alike", FindingCode::kFramesAlike},
    {"noise_bias", FindingCode::kNoiseBias},
    {"parameters_on_bounds", FindingCode::kParametersOnBounds},
    {"parameters_near_limits", FindingCode::kParametersNearLimits},
    {"discretization_error", FindingCode::kDiscretizationError},
    {"flat_facets", FindingCode::kFlatFacets},
    {"mesh_error_unknown", FindingCode::kMeshErrorUnknown},
    {"computed_by_linear_elements", FindingCode::kComputedByLinearElements},
    {"supports_end_within_elements", FindingCode::kSupportsEndWithinElements},
    {"solver_fallback", FindingCode::kSolverFallback},
    {"misfit", FindingCode::kMisfit},
    {"not_resolved", FindingCode::kNotResolved},
    {"noise_sd_needed", FindingCode::kNoiseNeeded},
    {"may_be_the_mesh", FindingCode::kMayBeTheMesh},
    {"local_map", FindingCode::kLocalMap},
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
