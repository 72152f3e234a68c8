#ifndef ELASTIMATE_BENCHMARKS_MEASUREMENT_STUDY_H_
#define ELASTIMATE_BENCHMARKS_MEASUREMENT_STUDY_H_

#include "benchmarks/study.h"

namespace elastimate {

/// What a camera, grips and a load cell do to an estimate by iterative-fe, and
/// what wrong assumptions about them do: for each of MeasurementLevels and
/// NoiseLevels the root mean square error, the errors that are stated, and
/// whether intervals cover the truth.
StudyResult RunMeasurementStudy(bool is_quick, Progress& progress);

}  // namespace elastimate

#endif  // ELASTIMATE_BENCHMARKS_MEASUREMENT_STUDY_H_
