#ifndef ELASTIMATE_BENCHMARKS_SPEED_ACCURACY_STUDY_H_
#define ELASTIMATE_BENCHMARKS_SPEED_ACCURACY_STUDY_H_

#include "benchmarks/study.h"

namespace elastimate {

/// Time against error of every estimator, on four scenes, in a world that the
/// mesh describes and in one that it does not, at four magnitudes of noise.
///
/// Tables: speed_accuracy (one row for each trial), speed_accuracy_points (one
/// for each method, scene, world and magnitude), speed_accuracy_summary (the
/// cheapest method within 1 % of E, and what auto chose).
StudyResult RunSpeedAccuracyStudy(bool is_quick, Progress& progress);

}  // namespace elastimate

#endif  // ELASTIMATE_BENCHMARKS_SPEED_ACCURACY_STUDY_H_
