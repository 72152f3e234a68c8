#ifndef ELASTIMATE_CORE_SOLVERS_PETSC_SPACES_H_
#define ELASTIMATE_CORE_SOLVERS_PETSC_SPACES_H_

#include "elastimate/core/solvers/multigrid_rows.h"
#include "elastimate/core/solvers/multigrid_spaces.h"

/// Finds coarse spaces for the matrix of the rows by smoothed aggregation
/// [Vanek, Mandel & Brezina 1996] from PETSc; they hold the rigid motions.
/// Columns of what it finds are numbered over all ranks.  Returns whether it
/// could.  Time and memory are proportional to the number of
/// nodes.  Throws std::bad_alloc.  core/solvers/multigrid.cc looks this
/// function up in the module.
extern "C" __attribute__((visibility("default"))) bool
elastimate_find_multigrid_spaces(elastimate::MultigridRows& rows,
                                 elastimate::MultigridSpaces& spaces);
extern "C" __attribute__((visibility("default"))) bool
elastimate_is_petsc_running();

#endif  // ELASTIMATE_CORE_SOLVERS_PETSC_SPACES_H_
