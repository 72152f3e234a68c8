#ifndef ELASTIMATE_CORE_SOLVERS_MULTIGRID_SPACES_H_
#define ELASTIMATE_CORE_SOLVERS_MULTIGRID_SPACES_H_

#include <Eigen/Core>
#include <vector>

#include "elastimate/core/solvers/block_matrix.h"

namespace elastimate {

/// A matrix in the spaces of a multigrid method, from coarse to fine.
struct MultigridSpaces {
  std::vector<BlockMatrix> matrices;
  /// From each space to the next finer one: one fewer than matrices.
  std::vector<BlockMatrix> interpolations;
  /// The row of the finest matrix for each free degree of freedom.  That matrix
  /// has all components of each node that has a free one; where a component is
  /// held, its row has only a diagonal entry.
  std::vector<int> row_of_free;
};

}  // namespace elastimate

#endif  // ELASTIMATE_CORE_SOLVERS_MULTIGRID_SPACES_H_
