#ifndef ELASTIMATE_CORE_SOLVERS_MULTIGRID_SPACES_H_
#define ELASTIMATE_CORE_SOLVERS_MULTIGRID_SPACES_H_

#include <vector>

#include "elastimate/core/solvers/divided_matrix.h"

namespace elastimate {

/// The coarse spaces of a multigrid method, from coarse to fine.
struct MultigridSpaces {
  /// The matrix of each coarse space, without that of the finest.
  std::vector<DividedMatrix> matrices;
  /// The interpolation from each coarse space to the next finer one.  The last
  /// leads to the finest space.
  std::vector<DividedMatrix> interpolations;
};

}  // namespace elastimate

#endif  // ELASTIMATE_CORE_SOLVERS_MULTIGRID_SPACES_H_
