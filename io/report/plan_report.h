#ifndef ELASTIMATE_IO_REPORT_PLAN_REPORT_H_
#define ELASTIMATE_IO_REPORT_PLAN_REPORT_H_

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "elastimate/estimators/plan/load_plan.h"
#include "elastimate/estimators/plan/map_plan.h"

namespace elastimate {

/// The basis of a plan.
struct PlanBasis {
  /// The load cases of the scene that count as measured, from 1 on, and whether
  /// they have been measured.
  std::vector<int> load_cases;
  bool is_measured;
  /// The origin of the parameters: "given", "estimate" or "typical".
  std::string_view parameters;
  /// Tells whether moduli have the unit of the loads, so that the sizes of
  /// loads mean something.
  bool is_scale_known;
  std::optional<double> noise_sd;  ///< [length]; empty if it is relative.
  double relative_noise;
  /// The load case of each candidate in the scene, from 1 on; 0 for a candidate
  /// that is not in the scene.
  std::vector<int> load_case_of_candidate;
  /// The standard errors, from all causes, of the free parameters in the
  /// estimate of the measured load cases. Empty where there is no usable
  /// estimate.
  std::vector<double> errors_of_estimate = {};
};

/// Returns a plan as a JSON text, described in docs/plan.md.  Numbers
/// round-trip; what is undetermined is null.
[[nodiscard]] std::string JsonPlan(const LoadPlan& plan, const PlanBasis& basis,
                                   const std::vector<CandidateLoad>& candidates,
                                   const std::vector<std::string>& notices);

/// Returns a plan of a map likewise.
[[nodiscard]] std::string JsonMapPlan(
    const MapPlan& plan, const PlanBasis& basis,
    const std::vector<CandidateLoad>& candidates,
    const std::vector<std::string>& notices);

}  // namespace elastimate

#endif  // ELASTIMATE_IO_REPORT_PLAN_REPORT_H_
