#ifndef ELASTIMATE_BENCHMARKS_LARGE_DEFORMATION_STUDY_H_
#define ELASTIMATE_BENCHMARKS_LARGE_DEFORMATION_STUDY_H_

#include "benchmarks/study.h"

namespace elastimate {

/// What small strains do to the estimate of a bar that bends or stretches far,
/// how well and at what cost the estimators fit its law of large strains, and
/// where there is no equilibrium (LargeDeformationLimits).
StudyResult RunLargeDeformationStudy(bool is_quick, Progress& progress);

}  // namespace elastimate

#endif  // ELASTIMATE_BENCHMARKS_LARGE_DEFORMATION_STUDY_H_
