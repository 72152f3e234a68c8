#ifndef ELASTIMATE_CORE_SOLVERS_PETSC_SPACES_H_
#define ELASTIMATE_CORE_SOLVERS_PETSC_SPACES_H_

#include <Eigen/Core>

#include "elastimate/core/mesh/mesh.h"
#include "elastimate/core/solvers/multigrid_spaces.h"
#include "elastimate/core/solvers/node_blocks.h"

/// Finds coarse spaces for the matrix of these values by smoothed aggregation
/// [Vanek, Mandel & Brezina 1996] from PETSc; they hold the rigid motions.
/// Returns whether it could.  Time and memory are proportional to the number of
/// nodes.  Throws std::bad_alloc.  Precondition: `blocks` are in the order of
/// the nodes.  core/solvers/multigrid.cc looks this function up in the module.
extern "C" __attribute__((visibility("default"))) bool
elastimate_find_multigrid_spaces(const elastimate::Mesh& mesh,
                                 const elastimate::NodeBlocks& blocks,
                                 const Eigen::VectorXd& values,
                                 elastimate::MultigridSpaces& spaces);
extern "C" __attribute__((visibility("default"))) bool
elastimate_is_petsc_running();

#endif  // ELASTIMATE_CORE_SOLVERS_PETSC_SPACES_H_
