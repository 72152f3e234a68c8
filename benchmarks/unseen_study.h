#ifndef ELASTIMATE_BENCHMARKS_UNSEEN_STUDY_H_
#define ELASTIMATE_BENCHMARKS_UNSEEN_STUDY_H_

#include "apps/progress.h"
#include "benchmarks/study.h"

namespace elastimate {

/// Whether error bars hold on shapes that nothing was built on (UnseenShapes),
/// in a world that the mesh describes and in finer ones.
///
/// Tables: unseen (one row for each trial), unseen_cells (coverage and
/// dishonesty), unseen_regret (what `auto` costs).
StudyResult RunUnseenStudy(bool is_quick, Progress& progress);

}  // namespace elastimate

#endif  // ELASTIMATE_BENCHMARKS_UNSEEN_STUDY_H_
