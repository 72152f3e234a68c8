#ifndef ELASTIMATE_CORE_SOLVERS_MULTIGRID_SPACES_H_
#define ELASTIMATE_CORE_SOLVERS_MULTIGRID_SPACES_H_

#include <vector>

#include "elastimate/core/solvers/block_matrix.h"

namespace elastimate {

/// The coarse spaces of a multigrid method, from coarse to fine.
struct MultigridSpaces {
  /// The matrix in each of them.
  std::vector<BlockMatrix> matrices;
  /// From each of them to the next finer one, at last to the finest space.
  std::vector<BlockMatrix> interpolations;
};

}  // namespace elastimate

#endif  // ELASTIMATE_CORE_SOLVERS_MULTIGRID_SPACES_H_
