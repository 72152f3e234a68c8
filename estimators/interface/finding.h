#ifndef ELASTIMATE_ESTIMATORS_INTERFACE_FINDING_H_
#define ELASTIMATE_ESTIMATORS_INTERFACE_FINDING_H_

#include <string>
#include <string_view>
#include <vector>

namespace elastimate {

/// How an estimator came out.
enum class Status {
  kOk,                ///< The estimate is usable.
  kNotIdentifiable,   ///< The data, or this method, leave E or nu undetermined.
  kUnphysical,        ///< E <= 0 or nu outside (-1, 1/2).
  kIterationLimit,    ///< The iteration did not converge.
  kNumericalFailure,  ///< A factorisation or an evaluation failed.
};

/// "ok", "not_identifiable", "unphysical", "iteration_limit" or
/// "numerical_failure".
[[nodiscard]] std::string_view StatusName(Status status);

/// What there is to say about an estimate; docs/findings.md explains each.
enum class FindingCode {
  // Why there is no estimate.
  kNotRun,
  kNumericalFailure,
  kNoConvergence,
  kFitNotCertified,
  kErrorsMissing,
  // Why it is unphysical.
  kUnphysical,
  // What the data do not determine.
  kParametersUndetermined,
  // What the model does not explain.
  kLargeDeformation,
  kNegativePoissonRatio,
  kMarginNotGiven,
  kPriorContradicted,
  kGivenValueContradicted,
  kLoadsOutOfBalance,
  kResidualAboveNoise,
  kSmoothResidual,
  kOutliers,
  kOutliersLeftOut,
  kHeldNodesMoved,
  kInvertedElements,
  kRigidFaceTurned,
  kResultantsContradicted,
  kRegionsMayDiffer,
  kLawsFitAlike,
  kFramesLeftOut,
  kTrendOverFrames,
  kFramesScatter,
  kFramesAlike,
  // What the method does to the estimate.
  kNoiseBias,
  kParametersOnBounds,
  kParametersNearLimits,
  kDiscretizationError,
  kFlatFacets,
  kMeshErrorUnknown,
  kComputedByLinearElements,
  kSupportsEndWithinElements,
  kSolverFallback,
  // What a map does not tell.
  kMisfit,
  kNotResolved,
  kNoiseNeeded,
  kMayBeTheMesh,
  kLocalMap,
};

/// What a finding means for the estimate.
enum class Severity {
  kNotice,   ///< Does not change the result.
  kWarning,  ///< The result is usable all the same.
  kError,    ///< Why the result is not usable.
};

/// One thing to say about an estimate.  Both sentences are plain English, start
/// with a small letter, have no full stop, and are not empty; they have 40
/// words together at most.
struct Finding {
  FindingCode code;
  Severity severity;
  std::string text;    ///< What was found, with its numbers.
  std::string advice;  ///< What to do, with the exact flag or key.
};

/// The name of a code in reports, such as "smooth_residual".
[[nodiscard]] std::string_view FindingCodeName(FindingCode code);
/// "notice", "warning" or "error".
[[nodiscard]] std::string_view SeverityName(Severity severity);
/// The status of an estimate that is not usable for this reason.
[[nodiscard]] Status StatusOf(FindingCode code);
/// All codes, in the order above.
[[nodiscard]] std::vector<FindingCode> AllFindingCodes();

/// "text; advice".
[[nodiscard]] std::string Sentence(const Finding& finding);

}  // namespace elastimate

#endif  // ELASTIMATE_ESTIMATORS_INTERFACE_FINDING_H_
