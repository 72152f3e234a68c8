#ifndef ELASTIMATE_BENCHMARKS_STABILITY_STUDY_H_
#define ELASTIMATE_BENCHMARKS_STABILITY_STUDY_H_

#include "apps/progress.h"
#include "benchmarks/study.h"

namespace elastimate {

/// Where each estimator fails, and whether it says so: the levels of
/// StabilityLevels, each with the same noises.
///
///   stability                 all trials
///   stability_cells           what they add up to, for each level and
///   estimator
///
/// A trial is dishonest when its status is ok although E is off by more than 3
/// standard errors and by more than 10 %, or nu by more than 3 standard errors
/// and 0.03 and the truth is outside its interval.  A standard error that is
/// missing counts as zero.
StudyResult RunStabilityStudy(bool is_quick, Progress& progress);

}  // namespace elastimate

#endif  // ELASTIMATE_BENCHMARKS_STABILITY_STUDY_H_
