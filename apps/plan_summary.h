#ifndef ELASTIMATE_APPS_PLAN_SUMMARY_H_
#define ELASTIMATE_APPS_PLAN_SUMMARY_H_

#include <string>
#include <vector>

#include "elastimate/estimators/plan/load_plan.h"
#include "elastimate/io/report/plan_report.h"

namespace elastimate {

/// A short table of a plan for people.
std::string PlanSummary(const LoadPlan& plan, const PlanBasis& basis,
                        const std::vector<CandidateLoad>& candidates);

/// The table of a plan of a map.
std::string MapPlanSummary(const MapPlan& plan, const PlanBasis& basis,
                           const std::vector<CandidateLoad>& candidates);

}  // namespace elastimate

#endif  // ELASTIMATE_APPS_PLAN_SUMMARY_H_
