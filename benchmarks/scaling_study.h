#ifndef ELASTIMATE_BENCHMARKS_SCALING_STUDY_H_
#define ELASTIMATE_BENCHMARKS_SCALING_STUDY_H_

#include "benchmarks/study.h"

namespace elastimate {

/// Time and peak memory of every estimator against the number of tetrahedra,
/// each in a process of its own, within limits of both.
///
/// Tables: scaling (one row for each estimator and size), scaling_slopes (of
/// lines through the logarithms).
StudyResult RunScalingStudy(bool is_quick, Progress& progress);

}  // namespace elastimate

#endif  // ELASTIMATE_BENCHMARKS_SCALING_STUDY_H_
