#ifndef ELASTIMATE_BENCHMARKS_SOLVER_STUDY_H_
#define ELASTIMATE_BENCHMARKS_SOLVER_STUDY_H_

#include "benchmarks/study.h"

namespace elastimate {

/// Wall time and memory of the linear solvers, each in a process of its own:
/// `cholmod` is CHOLMOD as its manual shows it, on the same matrix; `cholesky`
/// and `multigrid` are those of the library.
///
/// Table: solvers (one row for each body, solver and number of threads of the
/// BLAS).
StudyResult RunSolverStudy(bool is_quick, Progress& progress);

}  // namespace elastimate

#endif  // ELASTIMATE_BENCHMARKS_SOLVER_STUDY_H_
