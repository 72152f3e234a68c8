#ifndef ELASTIMATE_BENCHMARKS_MATERIALS_STUDY_H_
#define ELASTIMATE_BENCHMARKS_MATERIALS_STUDY_H_

#include "benchmarks/study.h"

namespace elastimate {

/// How well the parameters of several materials are estimated, and how honest
/// that is, for each factor of MaterialLevels; and what wrong regions, too few
/// and too many do to the prediction of another load.
StudyResult RunMaterialsStudy(bool is_quick, Progress& progress);

}  // namespace elastimate

#endif  // ELASTIMATE_BENCHMARKS_MATERIALS_STUDY_H_
